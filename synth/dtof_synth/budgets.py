# SPDX-License-Identifier: Apache-2.0
"""Committed budgets of area and timing: changes against them, and proposals of new ones."""

from __future__ import annotations

import csv
from pathlib import Path

from .errors import FlowError
from .run import Result


TOLERANCE = 0.02  # of every figure, to both sides
FIGURES = ("logic_column_um2", "shared_um2", "sram_column_um2", "total_mm2", "power_mw", "fmax_slow_mhz", "fmax_typical_mhz")
Budget = dict[str, float]


def figures(result: Result) -> Budget:
    return {"logic_column_um2": round(result.column.area, 1), "shared_um2": round(result.shared.area, 1),
            "sram_column_um2": round(result.sram_area, 1), "total_mm2": round(result.total_mm2, 4),
            "power_mw": round(result.power.total, 1) if result.power else 0.0,
            "fmax_slow_mhz": round(result.timing["slow"].fmax_mhz, 1),
            "fmax_typical_mhz": round(result.timing["typical"].fmax_mhz, 1)}


def read(path: Path) -> dict[str, Budget]:
    """Budgets by configuration; empty if the file is missing."""
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


def moved(budgets: dict[str, Budget], results: dict[str, Result]) -> list[str]:
    """One line for each figure that differs from its budget by more than the tolerance, and for each name that only one list has."""
    lines = []
    for name, result in results.items():
        if name not in budgets:
            lines.append(f"{name}: no budget yet")
            continue
        for figure, value in figures(result).items():
            budget = budgets[name][figure]
            change = value / budget - 1 if budget else float(value != 0)
            if abs(change) > TOLERANCE:
                lines.append(f"{name}: {figure} {budget:g} -> {value:g} ({change:+.1%})")
    return lines + [f"{name}: has a budget but is no configuration" for name in budgets if name not in results]
