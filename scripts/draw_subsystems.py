#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws small subsystems with legal parameters, in the form of tb_cpp/tests/subsystem/models.cmake (`make random-subsystems`).

Each subsystem has another read-out or another size, since its tests are named after them. The read-outs come in the order of
readouts.toml, from one that the seed selects on. The buffer's size is drawn around those at which the rules of
docs/user/subsystem.md change: SLOTS, eight lines, an acquisition.
"""

from __future__ import annotations

import argparse
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path
from random import Random

from dtof_synth import program

ROOT = Path(__file__).resolve().parent.parent
WITHOUT_HISTOGRAM = ("ezpointer", "pifh")  # RAW_HISTOGRAM has no effect there
SLOW = ("histogram", "pifh")  # their scans grow with 2^NP, and the tests fill a counter
MOST_REGISTERS = 8  # lines; a longer buffer is an SRAM (dtof_line_path)
MOST = 60  # subsystems: more have no size of their own


def readouts() -> dict[str, bool]:
    """All read-outs with RTL; true if the array is poolPointer's."""
    with (ROOT / "readouts.toml").open("rb") as file:
        found = tomllib.load(file)["readout"]
    return {name: entry.get("top") == "dtof_pool_pointer_array" for name, entry in found.items() if "column" in entry or "top" in entry}


def buffer_lines(random: Random, acquisition: int, slots: int, source_waits: bool) -> int | None:
    """Lines of the buffer; None: the default."""
    least = 2 if source_waits else max(2, slots)
    return random.choice([None, *(max(least, lines) for lines in (
        least, least + 1, acquisition - 1, acquisition, acquisition + 4, MOST_REGISTERS, MOST_REGISTERS + 1, 17))])


def draw(random: Random, readout: str, pool: bool, columns: int, rows: int) -> str:
    """The parameters of a subsystem, as dtof_verilate takes them."""
    slots = random.choice([2, 2, 3, 4] if pool else [1, 2, 3, 4])
    most = 12 if pool else 8 if readout in SLOW else 10
    words = [f"READOUT {readout} NP {random.randint(8 if pool else 7, most)}",
             f"PIXELS_PER_SRAM {rows} SRAM_NUM {columns} SLOTS {slots}"]

    def maybe(text: str, probability: float = 0.4) -> None:
        if random.random() < probability:
            words.append(text)

    if pool:
        words.append(f"ENGINE_COLUMNS {random.choice([2, 4])}")
        maybe("SECOND_TARGET 1")
        maybe(random.choice(["AMPLITUDE 1", "RASTER_ORDER 1"]), 0.7)  # a raster buffer has no room for amplitudes
        if readout != "poolpointer-lean":  # whose words have no room for a prior
            maybe("PRIOR 1")
    elif readout not in WITHOUT_HISTOGRAM:
        maybe("RAW_HISTOGRAM 1")
    maybe("TIME_GATE 1")
    maybe("PARITY 1 WRITABLE_SRAMS")
    maybe(f"BROADCAST_STAGES {random.choice([1, 3, 5])}")
    maybe("SELF_TEST 1", 0.6)
    maybe("AXI_LITE 1")
    maybe("CLOCK_WAITS 0", 0.5)
    source_waits = random.random() < 0.5
    if not source_waits:
        words.append("SOURCE_WAITS 0")
    lines = buffer_lines(random, rows * slots, slots, source_waits)
    if lines is not None:
        words.append(f"BUFFER_LINES {lines}")
    return " ".join(words)


def drawn(seed: int, count: int) -> list[str]:
    random = Random(seed)
    names = list(readouts().items())
    seen: set[tuple[str, int, int]] = set()
    found: list[str] = []
    while len(found) < count:
        readout, pool = names[(seed + len(found)) % len(names)]
        size = (readout, random.randint(2, 7), random.choice([2, 3, 4, 5, 7, 9]))
        if size not in seen:
            seen.add(size)
            found.append(draw(random, readout, pool, size[1], size[2]))
    return found


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="Draws small subsystems with legal parameters.")
    parser.add_argument("--seed", type=int, default=1, help="at least 0")
    parser.add_argument("--count", type=int, default=12, help=f"number of subsystems, 1 to {MOST}")
    options = parser.parse_args(arguments)
    if options.seed < 0 or not 1 <= options.count <= MOST:
        print(f"error: --seed must be at least 0 and --count 1 to {MOST}", file=sys.stderr)
        return 2
    print("# Written by scripts/draw_subsystems.py.")
    for i, parameters in enumerate(drawn(options.seed, options.count)):
        print(f"dtof_verilate(drawn_{i} SUBSYSTEM {parameters} TARGET dtof_subsystem_models)")
    return 0


if __name__ == "__main__":
    program.run(main)
