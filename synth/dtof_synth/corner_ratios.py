# SPDX-License-Identifier: Apache-2.0
"""The slow corner read in three ways: its gates and its SRAMs are slowed by ratios from two kinds of source.

Gates: Nangate 45 nm's slow library over its typical one, 81 / 25.8. SRAMs: 2.2 ns over 1.2 ns of the access time. If one kind of
source is right for both, the slack is another; a claim whose sign hangs on the choice is none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from . import sram_kit, sram_model, standard_cells, technology
from .run import Result, retimed
from .standard_cells import SLOW, Corner
from .technology import Technology

GATES = SLOW.gate
SRAMS = sram_model.ACCESS_SLOW_NS / sram_model.ACCESS_TYPICAL_NS
READINGS = {"as the flow has it": (GATES, SRAMS), "gates slowed as the SRAMs": (SRAMS, SRAMS), "SRAMs slowed as the gates": (GATES, GATES)}


@dataclass(frozen=True)
class Reading:
    """Setup slack with margins, ns, of one netlist with other ratios of slow to typical delay."""

    name: str
    gates: float
    srams: float
    slack: float


def corner(gates: float) -> Corner:
    """The slow corner with another ratio of gate delays; registers scale in proportion."""
    scale = gates / SLOW.gate
    return replace(SLOW, gate=gates, clock_to_q=SLOW.clock_to_q * scale, setup=SLOW.setup * scale, hold=SLOW.hold * scale)


def macros(sizes: list[sram_model.Size], srams: float) -> list[sram_model.Macro]:
    """Macros whose slow access time is `srams` times the typical one."""
    return [replace(one, access_slow=one.access_typical * srams) for one in map(sram_model.macro, sizes)]


def read(result: Result, prepared: Technology, folder: Path) -> list[Reading]:
    """Slacks of the netlist that run.run left in `folder`, for each reading of the slow corner."""
    sizes = sram_kit.read_sizes(prepared.root / technology.SIZES)
    found = []
    for name, (gates, srams) in READINGS.items():
        cells, memories = folder / "slow_cells.lib", folder / "slow_srams.lib"
        cells.write_text(standard_cells.library(corner(gates)), encoding="utf-8")
        memories.write_text(sram_kit.liberty(macros(sizes, srams), SLOW), encoding="utf-8")
        report = retimed(result, prepared, folder, cells, memories, "sta_ratios.log", ("margins",), name)
        found.append(Reading(name, gates, srams, report.margin().slack))
    return found
