# SPDX-License-Identifier: Apache-2.0
"""Area of read-outs that have no RTL here: the SRAM model, and an estimate of their logic.

A column serves all rows at a timestamp per clock, as the project's columns do. A pixel whose timestamps change one of
several words has them in an SRAM of two ports, read and written in every clock; a pixel of one word is read in the clock
of its first timestamp and written in that of its last, so that one port will do. Wide words may lie in several macros
side by side.

Logic is what ezPointer's smallest column takes without the bits of its word, and for each bit of a rival's word a flip-flop
behind the read, one before the write, a full adder and a multiplexer. Further full adders (comparisons, products, quotients)
and tables are what the rival's model says (RivalHardware in models/dtof/rival/rival.hpp). Nothing is counted for control,
for pipeline stages of long sums and for saturation, nor for sending more bits per pixel: the estimate favours the rivals.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from . import sram_model, standard_cells
from .configuration import load, memories
from .errors import FlowError

SMALLEST = "ezpointer_bare_one_port"  # its column and shared logic are in every estimate
TABLE_BIT_UM2 = 0.08  # of a read-only memory: a third of the SRAM model's cell with six transistors
MOST_MACROS = 16  # side by side
# Read-outs whose histograms freeze with their first full bin: a flip-flop a pixel (docs/reference/readouts.md, Full counters).
FREEZING = ("hispointer", "sifh", "fifh", "threesteps", "histogram", "coarsehistogram")


@dataclass(frozen=True)
class Hardware:
    """Hardware of a pixel's memory and of its column (RivalHardware in models/dtof/rival/rival.hpp)."""

    words: int
    word_bits: int
    adder_bits: int = 0
    table_bits: int = 0


def _cell_um2(name: str) -> float:
    for gate in standard_cells.gates():
        if gate.name == name:
            return gate.pitches * standard_cells.PITCH_AREA_UM2
    raise FlowError(f"no standard cell is called {name}")


def bit_um2() -> float:
    """Area of the logic for one bit of a word that timestamps change, um2."""
    flip_flop = standard_cells.sequential_pitches("DFF") * standard_cells.PITCH_AREA_UM2
    return 2 * flip_flop + _cell_um2("FA_X1") + _cell_um2("MUX2_X1")


def flag_um2() -> float:
    """Area of a pixel's flag, um2: a flip-flop, the selection of the pixel, and its part of the OR of all selected flags."""
    flip_flop = standard_cells.sequential_pitches("DFF") * standard_cells.PITCH_AREA_UM2
    return flip_flop + 2 * _cell_um2("AND2_X1") + _cell_um2("OR2_X1")


def sram_um2(rows: int, hardware: Hardware) -> float:
    """Area of the smallest of 1 to MOST_MACROS macros side by side, um2."""
    ports = 1 if hardware.words == 1 else 2
    areas = []
    for macros in range(1, MOST_MACROS + 1):
        if macros <= hardware.word_bits:
            bits = -(-hardware.word_bits // macros)
            areas.append(macros * sram_model.macro(sram_model.Size(ports, rows * hardware.words, bits)).area)
    return min(areas)


@dataclass(frozen=True)
class Base:
    """Base of all estimates: figures of the configuration SMALLEST in reports/area.csv."""

    column_um2: float  # without the bits of its word
    shared_um2: float

    @classmethod
    def read(cls, area: Path) -> Base:
        with area.open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["configuration"] == SMALLEST:
                    bits = float(row["bits_per_pixel"])
                    return cls(float(row["column_um2"]) - bits * bit_um2(), float(row["shared_um2"]))
        raise FlowError(f"{area}: no configuration {SMALLEST}")


def logic_um2(base: Base, hardware: Hardware) -> float:
    return (base.column_um2 + hardware.word_bits * bit_um2() + hardware.adder_bits * _cell_um2("FA_X1")
            + hardware.table_bits * TABLE_BIT_UM2)


def array_mm2(base: Base, hardware: Hardware, columns: int, rows: int) -> float:
    return (columns * (sram_um2(rows, hardware) + logic_um2(base, hardware)) + base.shared_um2) * 1e-6


@dataclass(frozen=True)
class Beside:
    """The estimate for a read-out with synthesised RTL, for comparison."""

    title: str
    estimated_mm2: float
    synthesised_mm2: float


def beside_synthesis(area: Path, configurations: Path) -> list[Beside]:
    """Estimates for the thesis's read-outs: their SRAMs, logic for one word of each, and a flag per pixel if histograms freeze."""
    base = Base.read(area)
    known = load(configurations)
    found = []
    with area.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            configuration = known.get(row["configuration"])
            if configuration is None or configuration.variant_of or configuration.is_pool:
                continue
            sizes = memories(configuration).values()
            logic = logic_um2(base, Hardware(1, sum(size.bits for size in sizes)))
            if configuration.name in FREEZING:
                logic += configuration["PIXELS_PER_SRAM"] * flag_um2()
            sram = sum(sram_model.macro(size).area for size in sizes)
            estimated = (int(row["columns"]) * (sram + logic) + base.shared_um2) * 1e-6
            found.append(Beside(configuration.title, estimated, float(row["total_mm2"])))
    return found
