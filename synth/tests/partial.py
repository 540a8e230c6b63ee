# SPDX-License-Identifier: Apache-2.0
"""Objects that have only what a test needs."""

from types import SimpleNamespace
from typing import TypeVar, cast

Kind = TypeVar("Kind")


def part_of(kind: type[Kind], **attributes: object) -> Kind:
    """An object with these attributes of a `kind` and no others, for code that reads no others."""
    known = {*dir(kind), *(name for base in kind.__mro__ for name in getattr(base, "__annotations__", {}))}
    if unknown := attributes.keys() - known:
        raise AttributeError(f"{kind.__name__} has no {', '.join(sorted(unknown))}")
    return cast(Kind, SimpleNamespace(**attributes))
