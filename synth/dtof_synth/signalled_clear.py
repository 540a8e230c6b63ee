# SPDX-License-Identifier: Apache-2.0
"""Area of the signalled clear: one status flip-flop an SRAM address (thesis 4.4.2).

A column of the thesis's array would have 5,120 or 10,240 status bits; their area is linear in the number of
bits, so it is measured on two short columns and extended.
"""

from __future__ import annotations

from .batch import Job
from .configuration import Configuration, memories
from .run import Result

READOUT = "fifh"
PIXELS = (4, 8)
APPLIES_TO = ("hispointer", "fifh", "sifh")


def configurations(named: dict[str, Configuration]) -> list[Configuration]:
    """FiFH columns of 4 and 8 pixels, each with and without status bits."""
    base = named[READOUT]
    return [base.with_parameters(f"{READOUT}_clear{signalled}_pixels{pixels}", PIXELS_PER_SRAM=pixels,
                                 SIGNALLED_CLEAR=signalled)
            for pixels in PIXELS for signalled in (0, 1)]


def jobs(named: dict[str, Configuration]) -> list[Job]:
    return [Job(item, ("slow",), most_attempts=1) for item in configurations(named)]


def area_per_bit(named: dict[str, Configuration], results: dict[str, Result]) -> float:
    """Area of the logic per status bit, um2."""
    areas = {(item["PIXELS_PER_SRAM"], item["SIGNALLED_CLEAR"]): results[item.name].column.area
             for item in configurations(named)}
    low, high = ((areas[pixels, 1] - areas[pixels, 0]) for pixels in PIXELS)
    words = [memories(named[READOUT].with_parameters("", PIXELS_PER_SRAM=pixels))["histogram"].words
             for pixels in PIXELS]
    return (high - low) / (words[1] - words[0])


def section(named: dict[str, Configuration], results: dict[str, Result]) -> str:
    """Section in Markdown: area of the signalled clear in the thesis's array."""
    bit = area_per_bit(named, results)
    lines = ["## Signalled clear", "",
             f"One status bit an address costs {bit:.2f} um2 (measured on FiFH columns of {PIXELS[0]} and "
             f"{PIXELS[1]} pixels, with and without; linear in the bits). For the thesis's array:", "",
             "| read-out | status bits a column | um2 a column | array mm2 | with it |", "|---|---:|---:|---:|---:|"]
    for name in APPLIES_TO:
        result = results[name]
        words = memories(result.configuration)["histogram"].words
        extra = bit * words
        total = extra * result.columns / 1e6
        lines.append(f"| {result.configuration.title} | {words} | {extra:.0f} | {result.total_mm2:.2f} | "
                     f"{result.total_mm2 + total:.2f} ({total / result.total_mm2:+.0%}) |")
    return "\n".join([*lines, "", "It saves the clear of RESET, about 0.1 % of a frame's clocks: not worth it.",
                      ""])
