# SPDX-License-Identifier: Apache-2.0
"""How cost grows: one parameter at a time, from the thesis's array."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from .batch import Job
from .configuration import Configuration
from .errors import FlowError
from .run import Result

READOUTS = ("ezpointer", "hispointer", "sifh")
SWEEPS = {"NP": (8, 9, 10, 11, 12), "NB": (4, 5, 6, 7), "PIXELS_PER_SRAM": (40, 80, 160, 320),
          "SRAM_NUM": (50, 100, 200, 400)}
FWHM_NS, RANGE_NS = 2.0, 45.0

# poolPointer's candidates: labels and bits of a score. Their accuracy: scripts/trade.py.
CANDIDATES = ((4, 4), (5, 4), (6, 3), (6, 4), (7, 3), (8, 3))
ENGINE_CLOCKS = 333_440 - 220  # of a frame of 33,333 acquisitions in 11.0e6 clocks, less clears and pauses


def engine_columns(configuration: Configuration) -> int:
    """Columns that one engine of poolPointer has time for, shared evenly among the engines (docs/reference/poolpointer.md, Cycle
    budget)."""
    columns, labels = configuration["SRAM_NUM"], configuration["LABELS"]
    groups = -(-configuration["PIXELS_PER_SRAM"] // configuration["GROUP_SIZE"])
    rows = configuration["PIXELS_PER_SRAM"]
    for engines in range(1, columns + 1):
        share = -(-columns // engines)
        share += share % 2  # two columns share an SRAM
        columns_clocks = 2 * (rows + 4) * max(labels + 4, 9) + (rows + 9) * 6 + rows * max(6, engines + 1)
        if share // 2 * groups * (32 * labels + 45) + share * columns_clocks <= ENGINE_CLOCKS:
            return share
    raise FlowError(f"{configuration.name}: no engine has time for even one column")


def candidates(base: Configuration) -> list[tuple[str, int | str, Configuration]]:
    """(parameter, value, configuration) for each number and width of candidates, including the base."""
    points: list[tuple[str, int | str, Configuration]] = []
    for labels, bits in CANDIDATES:
        if (labels, bits) == (base["LABELS"], base["SCORE_BITS"]):
            item = base
        else:
            item = base.with_parameters(f"{base.name}_labels{labels}x{bits}", LABELS=labels, SCORE_BITS=bits)
            item = item.with_parameters(item.name, ENGINE_COLUMNS=engine_columns(item))
        points.append(("LABELS", f"{labels}x{bits}", item))
    return points


def point(base: Configuration, parameter: str, value: int) -> Configuration:
    """The base with one parameter changed, and with NP also the parameters that depend on it (NB, GUARD)."""
    changes = {parameter: value}
    if parameter == "NP":
        changes["NB"] = value // 2 + (1 if base.readout == "sifh" else 0)
        changes["GUARD"] = math.ceil(FWHM_NS / RANGE_NS * 2**value)
    return base.with_parameters(f"{base.name}_{parameter.lower()}{value}", **changes)


def sweep(configurations: dict[str, Configuration]) -> list[tuple[str, int | str, Configuration]]:
    """(parameter, value, configuration) for every point of the sweeps; the base is part of every sweep."""
    points: list[tuple[str, int | str, Configuration]] = []
    for readout in READOUTS:
        base = configurations[readout]
        for parameter, values in SWEEPS.items():
            if parameter == "NB" and readout == "ezpointer":
                continue
            for value in values:
                at_base = base[parameter] == value
                points.append((parameter, value, base if at_base else point(base, parameter, value)))
    return points + candidates(configurations["poolpointer"])


def jobs(configurations: dict[str, Configuration]) -> list[Job]:
    """Points that are no named configurations. They are timed in the slow corner only and mapped once: arrays of 400 columns never
    close."""
    return [Job(configuration, ("slow",), most_attempts=1) for _, _, configuration in sweep(configurations)
            if configuration.name not in configurations]


def write(points: list[tuple[str, int | str, Configuration]], results: dict[str, Result], reports: Path) -> None:
    """Writes growth.csv; scripts/growth_plot.py draws it."""
    rows = []
    for parameter, value, configuration in points:
        result = results[configuration.name]
        rows.append([configuration.readout, parameter, value, f"{result.total_mm2:.4f}",
                     f"{result.bits_per_pixel:.1f}", f"{result.timing['slow'].fmax_mhz:.1f}",
                     f"{result.column.area:.1f}", f"{result.shared.area:.1f}", f"{result.sram_area:.1f}"])
    with (reports / "growth.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["readout", "parameter", "value", "total_mm2", "bits_per_pixel", "fmax_slow_mhz",
                         "logic_column_um2", "shared_um2", "sram_column_um2"])
        writer.writerows(rows)
