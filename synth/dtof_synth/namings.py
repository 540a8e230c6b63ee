# SPDX-License-Identifier: Apache-2.0
"""Which names ABC mapped best with, kept from one run to the next.

A search over names takes most of a run's time and ends the same way as long as what is mapped is the same. So its end is
committed beside a digest of everything that goes into the mapping; where the digest is another, the search is made again.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from .errors import FlowError
from .files import write_if_changed

FILE = "synth/namings.csv"


@dataclass(frozen=True)
class Naming:
    """`effort`: index of run.efforts. `column`, `shared`: the naming of either part (synth/yosys/4_map.tcl)."""

    effort: int
    column: int
    shared: int
    digest: str


def read(path: Path) -> dict[str, Naming]:
    """By configuration; none if there is no file."""
    if not path.exists():
        return {}
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return {row["configuration"]: Naming(int(row["effort"]), int(row["column"]), int(row["shared"]), row["digest"])
                    for row in csv.DictReader(file)}
    except (KeyError, ValueError, TypeError):
        raise FlowError(f"{path}: not a list of namings; without this file make synth searches and writes a new one") from None


def write(path: Path, namings: dict[str, Naming], keep: Iterable[str]) -> None:
    """Adds to the file, in the order of `keep`, and drops what is not in there."""
    known = read(path) | namings
    lines = [",".join(["configuration", *(field.name for field in fields(Naming))])]
    lines += [",".join([name, *map(str, asdict(known[name]).values())]) for name in keep if name in known]
    write_if_changed(path, "\n".join(lines) + "\n")
