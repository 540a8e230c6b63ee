# SPDX-License-Identifier: Apache-2.0
"""Physical model of 40 nm SRAM macros: area, access time, energy, leakage.

Area: A = (Wp + w*C) * (Hp + h*R) with C = bits*mux columns and R = ceil(words/mux) rows, the mux that
minimises the area with 16 <= R <= 512 and an aspect ratio of at most 4, for which a wide array of few words has rows that
are not used. Nothing is fitted to the thesis.
Time, energy and leakage grow with size as CACTI 7's 40 nm low-standby-power arrays do (power laws in
words and bits; a read's energy is linear in the bits, since the points end at 64 of them and each further bit
has its own bit lines, sense amplifier and output). A write with a mask costs a read, and the part of the difference to a write that the
mask selects: the bit lines of the other bits swing as in a read. Access time is anchored at 1.2 ns typical and 2.2 ns slow for the thesis's largest
column memory. Sources and fit errors: docs/reference/technology.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .errors import FlowError, found_in

MUXES = (1, 2, 4, 8, 16, 32, 64)
ROWS = (16, 512)
MAX_ASPECT = 4.0
ACCESS_TYPICAL_NS = 1.2
ACCESS_SLOW_NS = 2.2
SETUP_NS = 0.15
HOLD_NS = 0.05
ANCHOR = (10240, 10)  # words, bits of the macro that has the access times above
MASK_UM2 = 12.0  # a part's write enable: an input flip-flop and the gate that drives the write drivers of its bits


@dataclass(frozen=True)
class PowerLaw:
    """scale * words^words_exponent * bits^bits_exponent."""

    scale: float
    words_exponent: float
    bits_exponent: float

    def __call__(self, words: int, bits: int) -> float:
        return self.scale * words**self.words_exponent * bits**self.bits_exponent


@dataclass(frozen=True)
class LinearInBits:
    """scale * words^words_exponent * (bits + offset). The offset is the cost of a word itself, in bits."""

    scale: float
    words_exponent: float
    offset: float

    def __call__(self, words: int, bits: int) -> float:
        return self.scale * words**self.words_exponent * (bits + self.offset)


@dataclass(frozen=True)
class PortKind:
    """Geometry in um, and laws of the CACTI points (ns, pJ, pJ, uW), for one kind of port."""

    module: str
    strip_width: float
    strip_height: float
    cell_area: float
    cell_height: float
    access: PowerLaw
    read_energy: LinearInBits
    write_energy: PowerLaw
    leakage: PowerLaw

    @property
    def cell_width(self) -> float:
        return self.cell_area / self.cell_height


# Least squares of log(value) over the 20 CACTI points of each kind (test_sram_model.py refits them).
KINDS = {
    1: PortKind("dtof_sram_1rw", 29.0, 22.5, 0.242, 0.30,
                access=PowerLaw(0.16173, 0.18204, 0.16401),
                read_energy=LinearInBits(7.7239e-4, 0.66146, 3.6932),
                write_energy=PowerLaw(4.0184e-3, 0.43953, 1.06473),
                leakage=PowerLaw(5.1345e-6, 0.96475, 0.93028)),
    2: PortKind("dtof_sram_1r1w", 55.6, 35.7, 0.472, 0.356,
                access=PowerLaw(0.17081, 0.17758, 0.16504),
                read_energy=LinearInBits(1.28916e-3, 0.62510, 4.6459),
                write_energy=PowerLaw(4.1414e-3, 0.45769, 1.05031),
                leakage=PowerLaw(5.4041e-6, 0.97710, 0.94414)),
}


@dataclass(frozen=True, order=True)
class Size:
    """A macro size. ports: 1 (1RW) or 2 (1R1W). parts: parts of a word of equal width, each with a write enable; 1: no write mask."""

    ports: int
    words: int
    bits: int
    parts: int = 1

    @property
    def name(self) -> str:
        parts = f"_{self.parts}p" if self.parts > 1 else ""
        return f"{KINDS[self.ports].module.removeprefix('dtof_')}_{self.words}x{self.bits}{parts}"

    @classmethod
    def of_name(cls, name: str) -> Size:
        """The size of a macro's name."""
        ports, words, bits, parts = found_in("Yosys", r"^sram_(1rw|1r1w)_(\d+)x(\d+)(?:_(\d+)p)?$", name).groups()
        return cls(1 if ports == "1rw" else 2, int(words), int(bits), int(parts or 1))

    @property
    def address_bits(self) -> int:
        return max(1, math.ceil(math.log2(self.words)))

    @property
    def capacity(self) -> int:
        return self.words * self.bits


@dataclass(frozen=True)
class Macro:
    """Organisation and figures of one macro. Area in um2, times in ns, energy in pJ, leakage in uW."""

    size: Size
    banks: int
    mux: int
    rows: int
    columns: int
    width: float
    height: float
    access_typical: float
    access_slow: float
    read_energy: float
    write_energy: float
    leakage: float
    setup: float = SETUP_NS
    hold: float = HOLD_NS

    @property
    def area(self) -> float:
        return self.width * self.height

    def write_energy_of(self, parts: float) -> float:
        """Energy in pJ of a write of this many parts of the word, on average. The bit lines of the other parts swing as in a read."""
        least = min(self.read_energy, self.write_energy)
        return least + (self.write_energy - least) * parts / self.size.parts

    def organisation(self) -> str:
        banks = f"{self.banks} banks of " if self.banks > 1 else ""
        return f"{banks}{self.rows} rows x {self.columns} columns, mux {self.mux}"


def _bank(kind: PortKind, words: int, bits: int,
          muxes: tuple[int, ...]) -> tuple[float, int, int, int, float, float] | None:
    """(area, mux, rows, columns, width, height) of the best legal array, or None. If only one mux is given, any aspect ratio is legal."""
    best = None
    most_aspect = MAX_ASPECT if len(muxes) > 1 else math.inf
    for mux in muxes:
        rows, columns = math.ceil(words / mux), bits * mux
        width = kind.strip_width + kind.cell_width * columns
        if rows >= ROWS[0] and len(muxes) > 1:
            rows = max(rows, math.ceil((width / most_aspect - kind.strip_height) / kind.cell_height))
        height = kind.strip_height + kind.cell_height * rows
        legal = ROWS[0] <= rows <= ROWS[1] and max(width / height, height / width) <= most_aspect
        if words < ROWS[0]:
            legal = mux == 1
        if legal and (best is None or width * height < best[0]):
            best = (width * height, mux, rows, columns, width, height)
    return best


def macro(size: Size, mux: int | None = None) -> Macro:
    """Figures of a size, with the multiplexer of least area or with `mux`. A memory too large for one array is divided into equal banks
    side by side."""
    if size.ports not in KINDS or size.words < 1 or size.bits < 1:
        raise FlowError(f"no SRAM macro for {size}: ports must be 1 or 2, words and bits at least 1")
    kind = KINDS[size.ports]
    muxes = MUXES if mux is None else (mux,)
    banks, best = 1, _bank(kind, size.words, size.bits, muxes)
    while best is None and banks < 64:
        banks *= 2
        best = _bank(kind, math.ceil(size.words / banks), size.bits, muxes)
    if best is None:
        raise FlowError(f"{size.name}: no organisation with {ROWS[0]} to {ROWS[1]} rows and an aspect "
                        f"ratio up to {MAX_ASPECT:g} exists, even in {banks} banks")
    _, chosen, rows, columns, width, height = best
    words = max(size.words, ((rows - 1) * chosen + 1) * banks)  # with those that nobody asked for
    if size.parts > 1:
        width += MASK_UM2 * size.parts / height
    growth = kind.access(words, size.bits) / kind.access(*ANCHOR)
    return Macro(size, banks, chosen, rows, columns, width * banks, height,
                 ACCESS_TYPICAL_NS * growth, ACCESS_SLOW_NS * growth,
                 kind.read_energy(words, size.bits), kind.write_energy(words, size.bits),
                 kind.leakage(words, size.bits))
