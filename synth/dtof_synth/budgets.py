# SPDX-License-Identifier: Apache-2.0
"""Committed area and timing budgets: what moved against them, and the proposal of new ones."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from .errors import FlowError
from .run import Result


@dataclass(frozen=True)
class Figure:
    larger_is_worse: bool
    tolerance: float


_AREA = Figure(True, 0.02)
# The smallest mapping is kept, whatever its speed: the frequencies of the same logic under other names differ by up to 9.5 %.
_FREQUENCY = Figure(False, 0.1)
FIGURES = {"logic_column_um2": _AREA, "shared_um2": _AREA, "sram_column_um2": _AREA, "total_mm2": _AREA,
           "fmax_slow_mhz": _FREQUENCY, "fmax_typical_mhz": _FREQUENCY}
Budget = dict[str, float]


def figures(result: Result) -> Budget:
    return {"logic_column_um2": round(result.column.area, 1), "shared_um2": round(result.shared.area, 1),
            "sram_column_um2": round(result.sram_area, 1), "total_mm2": round(result.total_mm2, 4),
            "fmax_slow_mhz": round(result.timing["slow"].fmax_mhz, 1),
            "fmax_typical_mhz": round(result.timing["typical"].fmax_mhz, 1)}


def read(path: Path) -> dict[str, Budget]:
    """Budgets by configuration; none if there is no file."""
    if not path.exists():
        return {}
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return {row["configuration"]: {name: float(row[name]) for name in FIGURES}
                    for row in csv.DictReader(file)}
    except (KeyError, ValueError, TypeError):
        raise FlowError(f"{path}: not a budget file; make synth-budgets writes a new one") from None


def write(path: Path, results: dict[str, Result]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ["configuration", *FIGURES], lineterminator="\n")
        writer.writeheader()
        for name, result in results.items():
            writer.writerow({"configuration": name, **figures(result)})


def moved(budgets: dict[str, Budget], results: dict[str, Result]) -> tuple[list[str], bool]:
    """(one line for each figure off by more than the tolerance, whether one got worse)."""
    lines, worse = [], False
    for name, result in results.items():
        if name not in budgets:
            lines.append(f"{name}: no budget yet")
            continue
        for figure, value in figures(result).items():
            budget = budgets[name][figure]
            change = value / budget - 1 if budget else 0.0
            if abs(change) > FIGURES[figure].tolerance:
                bad = (change > 0) == FIGURES[figure].larger_is_worse
                worse |= bad
                lines.append(f"{name}: {figure} {budget:g} -> {value:g} ({change:+.1%}, "
                             f"{'worse' if bad else 'better'})")
    lines += [f"{name}: has a budget but is no configuration" for name in budgets if name not in results]
    return lines, worse
