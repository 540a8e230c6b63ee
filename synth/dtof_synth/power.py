# SPDX-License-Identifier: Apache-2.0
"""Power of the whole array in the typical corner at 330 MHz, while a frame is being measured.

Logic comes from OpenSTA's report of every cell; SRAM from access energies and access rates; the clock from the
flip-flops' clock pins and an estimated clock tree. Activities are stated, not simulated (docs/reference/synthesis.md).
"""

from __future__ import annotations

from dataclasses import dataclass

from .errors import found_in
from . import sram_model
from .configuration import Configuration, engine_memories, memories, shared_memories
from .library import Library
from .netlist import TREE_LOAD_SHARE

ACTIVITY = 0.1  # transitions of a data net per clock
DETECTION_RATE = 0.25  # share of TDC slots that hold a detection


@dataclass(frozen=True)
class Power:
    """Power of the array, mW."""

    logic: float
    sram: float
    clock: float

    @property
    def total(self) -> float:
        return self.logic + self.sram + self.clock


@dataclass(frozen=True)
class ClockTree:
    """Estimated clock tree: buffers of the largest kind; each level is filled to a share of its load limit."""

    buffers: int
    area: float
    load_ff: float


def clock_tree(flip_flops: int, pins_ff: float, library: Library) -> ClockTree:
    buffer = library.buffers[-1]
    limit = buffer.max_load_ff * TREE_LOAD_SHARE
    load = pins_ff + flip_flops * library.wire_ff_per_sink
    total_load, total_buffers = load, 0
    while load > limit:
        level = -(-load // limit)
        total_buffers += int(level)
        load = level * (buffer.input_ff + library.wire_ff_per_sink)
        total_load += load
    return ClockTree(total_buffers, total_buffers * buffer.area, total_load)


@dataclass(frozen=True)
class _Sums:
    """Power sums of some cells, W."""

    internal: float
    switching: float
    leakage: float


def _sums(output: str, label: str, group: str) -> _Sums:
    """Power sums in the output of synth/sta/cell_power.tcl. OpenSTA of 2019 adds rise and fall energy for every transition, so its internal
    power is twice the power and is halved here; test_flow_checks.py pins that behaviour."""
    found = found_in("OpenSTA", rf"^DTOF_POWER {label} {group} (\S+) (\S+) (\S+)$", output)
    internal, switching, leakage = (float(number) for number in found.groups())
    return _Sums(internal / 2, switching, leakage)


def _array(output: str, label: str, modules: int) -> _Sums:
    """Sums of the array: one column module times their number, plus everything outside."""
    column, shared = _sums(output, label, "column"), _sums(output, label, "shared")
    return _Sums(modules * column.internal + shared.internal, modules * column.switching + shared.switching,
                 modules * column.leakage + shared.leakage)


def logic_mw(output: str, modules: int) -> float:
    """Power of the logic without the clock, mW."""
    everything, clock = (_array(output, label, modules) for label in ("ALL", "CLOCK"))
    return (everything.internal - clock.internal + everything.switching + everything.leakage) * 1e3


def data_mw(output: str) -> float:
    """Power of one column's data nets, mW: total minus that with idle data, without leakage."""
    everything, clock = (_sums(output, label, "column") for label in ("ALL", "CLOCK"))
    return (everything.internal + everything.switching - clock.internal - clock.switching) * 1e3


def clock_mw(output: str, modules: int, tree: ClockTree, library: Library, mhz: float) -> float:
    """Power of the flip-flops' clock pins and of the tree's wires and pins, charged once per clock, mW."""
    return _array(output, "CLOCK", modules).internal * 1e3 + tree.load_ff * library.voltage**2 * mhz * 1e-6


def access_rates(configuration: Configuration) -> dict[str, tuple[float, float]]:
    """(reads, writes) per clock of each SRAM of a column module, averaged over the measurements of a frame."""
    pixel_rate = 1 / configuration["SLOTS"]
    half = 0.5 if configuration.has_pointer else 1.0
    if configuration.is_pool:  # words of two rows in three quarters of the frame, two parts of the bins for them in the first
        word_rate = pixel_rate / 2
        return {"pixels and groups": (0.25 * 2 * word_rate + 0.75 * word_rate,) * 2}
    return {"histogram": (half * DETECTION_RATE, half * DETECTION_RATE),
            "pointer": ((pixel_rate, pixel_rate) if configuration.readout == "ezpointer"
                        else (pixel_rate / 2, pixel_rate / 2)),
            "coarse peak": (pixel_rate / 2, 0.0), "best peak": (0.0, 0.0)}


def sram_mw(configuration: Configuration, mhz: float) -> float:
    """Power of all SRAMs of all columns, mW."""
    rates = access_rates(configuration)
    total = shared = 0.0
    for use, size in memories(configuration).items():
        macro = sram_model.macro(size)
        reads, writes = rates[use]
        dynamic = (reads * macro.read_energy + writes * macro.write_energy) * mhz * 1e-3
        total += dynamic + macro.leakage * 1e-3
    # Those of the shared logic are read and written with those of the columns, those of the engines rest.
    for size in shared_memories(configuration).values():
        macro = sram_model.macro(size)
        reads, writes = next(iter(rates.values()))
        shared += (reads * macro.read_energy + writes * macro.write_energy) * mhz * 1e-3 + macro.leakage * 1e-3
    idle = sum(sram_model.macro(size).leakage for size in engine_memories(configuration).values())
    return total * configuration.column_modules + shared + configuration.engines * idle * 1e-3
