# SPDX-License-Identifier: Apache-2.0
"""IHP's 130 nm open process: its compiled SRAM macros in place of the model's, as far as they fit.

A memory is made of copies of one macro side by side: words of the macro's width each, as deep as the macro or less.
Deeper memories would need a multiplexer behind the macros, which the RTL does not have; they keep the model's macro
and are named. Figures: LEF SIZE and Liberty of the PDK (typical 1.20 V 25 C, slow 1.08 V 125 C).
"""

from __future__ import annotations

import gzip
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from . import liberty, sram_model
from .errors import FlowError
from .liberty import Group
from .sram_model import Macro, Size

TYPICAL_SUFFIX = "_typ_1p20V_25C"
SLOW_SUFFIX = "_slow_1p08V_125C"
_NAME = re.compile(r"RM_IHPSG13_([12])P_(\d+)x(\d+)_c(\d+)")


@dataclass(frozen=True)
class Compiled:
    """A macro of the PDK. Lengths in um, times in ns; delays and constraints are those in the middle of their tables."""

    name: str
    size: Size
    mux: int
    width: float
    height: float
    access_typical: float
    access_slow: float
    setup: float  # of the slow corner, worst pin
    hold: float

    @property
    def area(self) -> float:
        return self.width * self.height


def cells(pdk: Path) -> tuple[Path, Path]:
    """Liberty files of the standard cells, typical and slow."""
    folder = pdk / "ihp130"
    return folder / f"sg13g2_stdcell{TYPICAL_SUFFIX}.lib.gz", folder / f"sg13g2_stdcell{SLOW_SUFFIX}.lib.gz"


def _middle(table: Group) -> float:
    rows = [value for name, value in table.attributes if name == "values"]
    numbers = [[float(text) for text in row.split(",")] for row in rows[0]]
    row = numbers[len(numbers) // 2]
    return row[len(row) // 2]


def _timings(group: Group) -> Iterable[Group]:
    for child in group.groups:
        if child.kind == "timing":
            yield child
        else:
            yield from _timings(child)


def _worst(cell: Group, kind: str, tables: tuple[str, ...]) -> float:
    """Largest figure of the functional pins; pins of the macro's self-test are ignored."""
    found = [_middle(table) for pin in cell.groups if "BIST" not in pin.name
             for timing in _timings(pin) if timing.get("timing_type") == kind
             for table in timing.groups if table.kind in tables]
    if not found:
        raise FlowError(f"{cell.name}: no timing of type {kind}")
    return max(found)


def _cell(path: Path) -> Group:
    return liberty.read(path).children("cell")[0]


def read(folder: Path) -> list[Compiled]:
    """All macros of the folder that have LEF and both Liberty files."""
    macros = []
    for lef in sorted(folder.glob("*.lef.gz")):
        stem = lef.name.removesuffix(".lef.gz")
        name = _NAME.match(stem)
        typical, slow = (folder / f"{stem}{corner}.lib.gz" for corner in (TYPICAL_SUFFIX, SLOW_SUFFIX))
        size = re.search(r"SIZE\s+([\d.]+)\s+BY\s+([\d.]+)", gzip.decompress(lef.read_bytes()).decode())
        if name is None or size is None or not typical.exists() or not slow.exists():
            raise FlowError(f"{lef}: not a macro of which name, size, typical and slow Liberty are known")
        ports, words, bits, mux = map(int, name.groups())
        access = [_worst(_cell(path), "rising_edge", ("cell_rise", "cell_fall")) for path in (typical, slow)]
        constraints = [_worst(_cell(slow), kind, ("rise_constraint", "fall_constraint"))
                       for kind in ("setup_rising", "hold_rising")]
        macros.append(Compiled(stem, Size(ports, words, bits), mux, float(size.group(1)), float(size.group(2)),
                               *access, *constraints))
    return macros


def choose(size: Size, macros: list[Compiled]) -> tuple[int, Compiled] | None:
    """(number of copies side by side, macro) with the least area; None if all macros have too few words."""
    fitting = [(-(-size.bits // macro.size.bits), macro) for macro in macros
               if macro.size.ports == size.ports and macro.size.words >= size.words]
    return min(fitting, key=lambda choice: choice[0] * choice[1].area) if fitting else None


def macro(size: Size, macros: list[Compiled]) -> Macro:
    """The memory made of IHP's macros, or the model's macro if none fits."""
    ours = sram_model.macro(size)
    choice = choose(size, macros)
    if choice is None:
        return ours
    copies, one = choice
    return replace(ours, banks=copies, mux=one.mux, width=copies * one.width, height=one.height,
                   access_typical=one.access_typical, access_slow=one.access_slow, setup=one.setup, hold=one.hold)
