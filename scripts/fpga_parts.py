# SPDX-License-Identifier: Apache-2.0
"""Arrays that users of FPGAs have, and the smallest part of a family that holds each: the second half of reports/fpga_check.md.

An array is `dtof_subsystem` with ROWS x COLUMNS pixels. A part holds it if its block RAMs, 80 % of its look-up tables and its flip-flops are
enough; the rest is for a router. The numbers of the parts are from the makers' tables: AMD DS180 (7 series), Lattice FPGA-DS-02012 (ECP5).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

SIZES = (32, 64)  # rows and columns
READOUTS = ("ezpointer", "hispointer", "coarsehistogram", "poolpointer", "poolpointer-lean")
MOST_TABLES = 0.8  # share of a part's look-up tables that can be used


@dataclass(frozen=True)
class Part:
    """Capacity of a part; block RAMs of 18 Kbit."""

    name: str
    tables: int
    registers: int
    block_rams: int


@dataclass(frozen=True)
class Need:
    """What an array needs; block RAMs of 18 Kbit."""

    tables: int
    registers: int
    block_rams: int


PARTS = {  # smallest first
    "xilinx": (Part("XC7S15", 8_000, 16_000, 20), Part("XC7A35T", 20_800, 41_600, 100), Part("XC7A100T", 63_400, 126_800, 270),
               Part("XC7A200T", 134_600, 269_200, 730), Part("XC7K325T", 203_800, 407_600, 890)),
    "ecp5": (Part("LFE5U-25", 24_288, 24_288, 56), Part("LFE5U-45", 43_848, 43_848, 108), Part("LFE5U-85", 83_640, 83_640, 208)),
}  # fmt: skip


def holds(part: Part, need: Need) -> bool:
    return need.tables <= MOST_TABLES * part.tables and need.registers <= part.registers and need.block_rams <= part.block_rams


def answer(parts: tuple[Part, ...], need: Need) -> str:
    """The smallest part that holds the array, or what the largest part lacks."""
    found = next((part for part in parts if holds(part, need)), None)
    if found is not None:
        return found.name
    largest = parts[-1]
    lacks = [name for name, wanted, there in (("look-up tables", need.tables, MOST_TABLES * largest.tables),
                                              ("flip-flops", need.registers, largest.registers),
                                              ("block RAMs", need.block_rams, largest.block_rams)) if wanted > there]  # fmt: skip
    return f"none: {largest.name} has too few {' and '.join(lacks)}"


def section(needs: Mapping[tuple[str, int, str], Need], titles: Mapping[str, str], families: Mapping[str, str]) -> list[str]:
    """Lines of the report. `needs`: by read-out, size and family; `families`: titles of the families."""
    lines = ["## Arrays of 32 x 32 and 64 x 64 pixels", "",
             "`dtof_subsystem` around the whole array, mapped like the small one above. Block RAMs: of 18 Kbit; one of 36 Kbit counts twice. Part: "
             f"the smallest of the list that has enough block RAMs and flip-flops, and enough look-up tables if {MOST_TABLES:.0%} of them can be "
             "used. A column's SRAM takes a block RAM of its own, however few words it has, so block RAMs decide.", "",
             "Parts: " + "; ".join(f"{families[family]}: " + ", ".join(
                 f"{part.name} ({part.tables:,} look-up tables, {part.registers:,} flip-flops, {part.block_rams} block RAMs)" for part in parts)
                 for family, parts in PARTS.items()) + ".", "",
             "| read-out | pixels | " + " | ".join(f"{families[family]}: block RAMs | look-up tables | flip-flops | part" for family in PARTS) + " |",
             "|---|---:|" + "---:|---:|---:|---|" * len(PARTS)]  # fmt: skip
    for name in READOUTS:
        for size in SIZES:
            figures = []
            for family, parts in PARTS.items():
                need = needs[name, size, family]
                figures.append(f"{need.block_rams} | {need.tables:,} | {need.registers:,} | {answer(parts, need)}")
            lines.append(f"| {titles[name]} | {size} x {size} | " + " | ".join(figures) + " |")
    return [*lines, ""]
