# SPDX-License-Identifier: Apache-2.0
"""Read energy of words wider than the points that the SRAM model is fitted to, beside public figures that come from CACTI.

OpenROAD-flow-scripts has macros of 96 to 256 bits in its platform nangate45, made by bsg_fakeram with CACTI's energies
(flow/platforms/nangate45/lib/fakeram45_*.lib: the clock's internal power; 64x96 as of commit 343c9f4, 64x124 of 2b4010b,
64x256 of 0476964, 128x64 of 55ce7f5, the others of 384023b). Their unit is not that of an access, so that only ratios of one
series are used: by how much a wide word costs more than one of 64 bits.
"""

from __future__ import annotations

import math
from statistics import mean

from . import sram_model

FITTED_BITS = 64  # of the widest point of CACTI that the model is fitted to
# Words: bits and energy of a read.
MACROS = {64: {64: 2497.93, 96: 2986.13, 124: 5492.0, 256: 13566.9},
          128: {64: 2761.52, 116: 5212.75, 256: 15691.4}}


def model_growth(bits: int) -> float:
    """Read energy of the model's one-port words of `bits` bits relative to FITTED_BITS."""
    law = sram_model.KINDS[1].read_energy
    return law(1, bits) / law(1, FITTED_BITS)


def growth(series: dict[int, float], bits: int) -> float:
    """Read energy of `bits` bits in a series, relative to FITTED_BITS: straight lines between the logarithms of its points, continued beyond the last one."""
    widths = sorted(series)
    above = next((index for index, width in enumerate(widths) if width >= bits and index > 0), len(widths) - 1)
    low, high = widths[above - 1], widths[above]
    exponent = math.log(series[high] / series[low]) / math.log(high / low)
    return series[low] * (bits / low)**exponent / series[FITTED_BITS]


def read_factor(bits: int) -> float:
    """Factor on the model's energy of a read of `bits` bits if energy grew beyond FITTED_BITS as the mean of the series."""
    if bits <= FITTED_BITS:
        return 1.0
    return mean(growth(series, bits) for series in MACROS.values()) / model_growth(bits)


def lines() -> list[str]:
    """Markdown: the model compared with all points."""
    rows = [f"| {words} x {bits} | {energy / series[FITTED_BITS]:.2f} | {model_growth(bits):.2f} | "
            f"{model_growth(bits) * series[FITTED_BITS] / energy:.2f} |"
            for words, series in MACROS.items() for bits, energy in series.items() if bits > FITTED_BITS]
    return ["### Words of 96 to 256 bits", "",
            f"Read energy over that of a word of {FITTED_BITS} bits: OpenROAD's macros for Nangate 45, whose energies are CACTI's "
            "(source: `synth/dtof_synth/wide_words.py`), and the model.", "",
            "| words x bits | CACTI | model | model / CACTI |", "|---|---:|---:|---:|", *rows, "",
            "CACTI leads all bits of a word to one place, over wires that get longer with each of them; a compiled macro has the "
            "pin of a bit below its column, which costs each bit the same. The model stays linear, and [power.md](power.md) has "
            "what arrays with wide words would take if reads grew as here."]
