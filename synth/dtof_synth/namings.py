# SPDX-License-Identifier: Apache-2.0
"""Dependence of area and slack on names. Names influence ABC's result and nothing else.

`make synth` maps with one naming, the same for every configuration. Here each configuration is mapped with several namings, and a read-out
closes its clock only if it closes with all of them.
"""

from __future__ import annotations

import csv
import statistics
from dataclasses import dataclass
from pathlib import Path

from .batch import Job
from .configuration import Configuration
from .run import Result

NAMINGS = 8
_SLOW, _FAST = "slow", "fast"


@dataclass(frozen=True)
class Spread:
    """Results of one configuration with all namings. Areas of the array in mm2, slacks in ns. `quoted`: the naming of `make synth`."""

    title: str
    quoted: float
    areas: tuple[float, ...]
    setup: tuple[float, ...]  # slow corner, with margins
    hold: tuple[float, ...]  # fast corner, with margins

    @property
    def median(self) -> float:
        return statistics.median(self.areas)

    @property
    def spread(self) -> float:
        """(largest area - smallest area) / median."""
        return (max(self.areas) - min(self.areas)) / self.median

    @property
    def closing(self) -> int:
        return sum(setup >= 0 and hold >= 0 for setup, hold in zip(self.setup, self.hold, strict=True))

    @property
    def closes(self) -> bool:
        return self.closing == len(self.areas)


def jobs(configurations: list[Configuration]) -> list[Job]:
    return [Job(item, naming=naming) for item in configurations for naming in range(NAMINGS)]


def spreads(configurations: list[Configuration], results: dict[str, Result]) -> dict[str, Spread]:
    """Spread by configuration, from the results of `jobs`."""
    found = {}
    for item in configurations:
        own = [results[Job(item, naming=naming).name] for naming in range(NAMINGS)]
        found[item.name] = Spread(item.title, own[0].total_mm2, tuple(one.total_mm2 for one in own),
                                  tuple(one.margins[_SLOW].slack for one in own),
                                  tuple(one.margins[_FAST].hold_slack for one in own))
    return found


def table(found: dict[str, Spread]) -> str:
    rows = ["| read-out | quoted mm2 | median | smallest | largest | spread | worst setup ns | worst hold ns | closing |",
            "|---|---:|---:|---:|---:|---:|---:|---:|---:|"]
    rows += [f"| {one.title} | {one.quoted:.3f} | {one.median:.3f} | {min(one.areas):.3f} | {max(one.areas):.3f} | "
             f"{one.spread:.1%} | {min(one.setup):+.4f} | {min(one.hold):+.4f} | {one.closing} of {len(one.areas)} |"
             for one in found.values()]
    return "\n".join(rows)


def report(found: dict[str, Spread], digest: str) -> str:
    open_ones = [one.title for one in found.values() if not one.closes]
    answer = (f"Every read-out closes with every naming; the areas of one read-out differ by at most "
              f"{max(one.spread for one in found.values()):.1%}." if not open_ones
              else f"Not closed with every naming: {', '.join(open_ones)}.")
    return "\n".join([
        "# Namings", "",
        f"{answer}", "",
        f"Written by `make synth-namings`: {NAMINGS} namings, inputs `{digest[:12]}`. ABC's result depends on the names of cells and "
        "wires, on which nothing else depends. `make synth` maps every configuration with the first naming: `quoted` is its area, which "
        "no search chose. Slacks are with margins: setup in the slow corner, hold in the fast one.", "",
        table(found), ""])


def write_csv(path: Path, found: dict[str, Spread]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["configuration", "quoted_mm2", "median_mm2", "smallest_mm2", "largest_mm2", "worst_setup_ns", "worst_hold_ns",
                         "closing", "namings"])
        for name, one in found.items():
            writer.writerow([name, f"{one.quoted:.4f}", f"{one.median:.4f}", f"{min(one.areas):.4f}", f"{max(one.areas):.4f}",
                             f"{min(one.setup):.4f}", f"{min(one.hold):.4f}", one.closing, len(one.areas)])
