# SPDX-License-Identifier: Apache-2.0
"""The one error that ends the flow with one line for the user."""

from __future__ import annotations

import re
from typing import TypeVar

Found = TypeVar("Found")


class FlowError(Exception):
    """Says where and what; the command line prints it and exits with status 1."""


def given(value: Found | None, missing: str) -> Found:
    """The value, or FlowError with what is missing."""
    if value is None:
        raise FlowError(missing)
    return value


def found_in(tool: str, pattern: str, text: str) -> re.Match[str]:
    """The first place in a tool's output that has the pattern, lines by lines; FlowError names the tool and the pattern."""
    return given(re.search(pattern, text, re.MULTILINE), f"{tool}: its output has no '{pattern}'; is this another version?")
