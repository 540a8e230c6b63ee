# SPDX-License-Identifier: Apache-2.0
"""The goals of the design, checked against the results of the generated library."""

from __future__ import annotations

from dataclasses import dataclass

from .run import Result
from .technology import TARGET_MHZ
from .timing import FAST_MHZ

COLUMN_UM2 = {"ezpointer": 700.0}
COLUMN_UM2_OTHERS = 1200.0
ARRAY_MM2 = {"poolpointer": 1.15, "poolpointer_lean": 0.81}
ONE_PORT_EZPOINTER_MM2 = 0.65
# Table 1 of the thesis: rank by area, equal where alike. It ranks SiFH apart from FiFH at a ratio of 1.35 and
# FiFH with hisPointer, which differ by 0.2 %; areas within this ratio count as alike.
THESIS_RANK = {"ezpointer": 1, "hispointer": 2, "fifh": 2, "sifh": 3}
ALIKE = 1.05


@dataclass(frozen=True)
class Goal:
    """A goal and its value. `is_open`: not met, but the interval of the value contains the limit."""

    text: str
    value: str
    met: bool
    is_open: bool = False


def ranks(results: dict[str, Result]) -> dict[str, int]:
    """Ranks by area of the read-outs of Table 1, with our areas."""
    order = sorted(THESIS_RANK, key=lambda name: results[name].total_mm2)
    found: dict[str, int] = {}
    rank, first = 0, 0.0
    for name in order:
        area = results[name].total_mm2
        if not found or area > first * ALIKE:
            rank, first = rank + 1, area
        found[name] = rank
    return found


def check(results: dict[str, Result]) -> list[Goal]:
    """Goals for which all results are present."""
    goals = []
    for name, result in results.items():
        if result.configuration.variant_of:
            continue
        limit = COLUMN_UM2.get(name, COLUMN_UM2_OTHERS)
        title = result.configuration.title
        slow, typical = result.timing["slow"], result.timing["typical"]
        goals += [
            Goal(f"{title}: closes {TARGET_MHZ:g} MHz, slow corner", f"slack {slow.slack:+.3f} ns",
                 slow.slack >= 0),
            Goal(f"{title}: closes {FAST_MHZ:g} MHz, typical corner", f"slack {typical.fast_slack:+.3f} ns",
                 typical.fast_slack >= 0),
            Goal(f"{title}: array at most {ARRAY_MM2[name]:g} mm2", f"{result.total_mm2:.3f} mm2",
                 result.total_mm2 <= ARRAY_MM2[name]) if name in ARRAY_MM2 else
            Goal(f"{title}: logic of a column at most {limit:g} um2", f"{result.column.area:.0f} um2",
                 result.column.area <= limit)]
    if "ezpointer_one_port" in results:
        area = results["ezpointer_one_port"].total_mm2
        goals.append(Goal(f"ezPointer, one-port SRAM: array at most {ONE_PORT_EZPOINTER_MM2:g} mm2",
                          f"{area:.3f} mm2", area <= ONE_PORT_EZPOINTER_MM2))
    if THESIS_RANK.keys() <= results.keys():
        found = ranks(results)
        goals.append(Goal("Table 1: area ranks ezPointer 1, FiFH and hisPointer 2, SiFH 3",
                          ", ".join(f"{results[name].configuration.title} {rank}" for name, rank in found.items()),
                          found == THESIS_RANK))
    return goals
