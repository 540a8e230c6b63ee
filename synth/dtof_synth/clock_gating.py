# SPDX-License-Identifier: Apache-2.0
"""Clock gates for registers with a common enable, inserted between technology-independent synthesis and mapping.

The RTL has enables and no gates, so simulation, proofs and FPGAs use plain registers. If the library has an integrated clock gate,
registers of a column, a pair or an engine that share an enable get a gated clock instead of multiplexers, as a synthesis tool for silicon
does it. The top's own registers get a gate only in large groups, such as the words of an engine's line; the floorplan places these gates.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from .errors import FlowError
from .library import ClockGate, Library
from .netlist import CLOCK_GATE_PREFIX, TREE_LOAD_SHARE

FEWEST_BITS = 4  # below, a gate takes as much as it saves
FEWEST_BITS_OF_TOP = 32  # the top's registers stand apart, so that each group needs gates and wires of its own
_CELL = re.compile(r"^  cell (\S+) (\S+)$")
_CONNECT = re.compile(r"^    connect \\(\w+) (.+)$")
# Rising clock, enable high or low; with asynchronous reset; with a synchronous one that the enable rules, too.
_ENABLED = re.compile(r"^\$_(DFFE|SDFFCE)_P([NP][01])?([NP])_$")


@dataclass
class _Register:
    """A register of one bit: the lines of its text, its replacement, and its pins."""

    first: int
    last: int
    kind: str
    clock: str
    enable: tuple[str, str]  # signal, polarity


def _registers(lines: list[str], begin: int, end: int) -> Iterable[_Register]:
    index = begin
    while index < end:
        cell = _CELL.match(lines[index])
        kind = _ENABLED.match(cell.group(1)) if cell else None
        if kind:
            first, pins = index, {}
            while lines[index] != "  end":
                if connect := _CONNECT.match(lines[index]):
                    pins[connect.group(1)] = connect.group(2)
                index += 1
            family, reset, polarity = kind.groups()
            plain = f"$_DFF_P{reset or ''}_" if family == "DFFE" else f"$_SDFF_P{reset}_"
            yield _Register(first, index, plain, pins["C"], (pins["E"], polarity))
        index += 1


def _gate(number: int, clock: str, enable: str, gate: ClockGate) -> list[str]:
    name = f"\\{CLOCK_GATE_PREFIX}{number}"
    return [f"  cell \\{gate.name} {name}", f"    connect \\{gate.clock_pin} {clock}",
            f"    connect \\{gate.enable_pin} {enable}", f"    connect \\{gate.output_pin} {name}_clk", "  end"]


def _inverter(number: int, signal: str) -> list[str]:
    name = f"$clock_gate_not${number}"
    return [f"  cell $_NOT_ {name}$cell", f"    connect \\A {signal}", f"    connect \\Y {name}", "  end"]


def _clusters(registers: list[_Register], most: int) -> list[list[_Register]]:
    """Divides registers into the fewest groups of at most `most`, of nearly equal sizes, in the order of the netlist."""
    number = -(-len(registers) // most)
    return [registers[index * len(registers) // number:(index + 1) * len(registers) // number] for index in range(number)]


def gated(text: str, library: Library) -> tuple[str, int]:
    """The netlist (RTLIL) with clock gates, and their number."""
    lines = text.splitlines()
    if not library.clock_gates:
        raise FlowError("the library has no clock gate")
    register_ff = max(library.clock_pin_ff[kind] for kind in library.sequential) + library.wire_ff_per_sink
    carries = {gate: max(FEWEST_BITS, int(gate.max_load_ff * TREE_LOAD_SHARE / register_ff)) for gate in library.clock_gates}
    most = max(carries.values())
    replaced: dict[int, list[str]] = {}  # lines that others take the place of
    number = 0
    begins = [index for index, line in enumerate(lines) if line.startswith("module ")]
    for begin in begins:
        end = lines.index("end", begin)
        attributes = begin
        while lines[attributes - 1].startswith("attribute "):
            attributes -= 1
        if any(line.startswith("attribute \\blackbox ") for line in lines[attributes:begin]):
            continue
        is_top = any(line.startswith("attribute \\top ") for line in lines[attributes:begin])
        fewest = FEWEST_BITS_OF_TOP if is_top else FEWEST_BITS
        groups: dict[tuple, list[_Register]] = {}
        for register in _registers(lines, begin, end):
            groups.setdefault((register.clock, register.enable), []).append(register)
        wires: list[str] = []  # Yosys wants them before the cells
        added: list[str] = []
        for (clock, (enable, polarity)), registers in groups.items():
            if len(registers) < fewest:
                continue
            if polarity == "N":
                wires.append(f"  wire $clock_gate_not${number}")
                added += _inverter(number, enable)
                enable = f"$clock_gate_not${number}"
            for cluster in _clusters(registers, most):
                gate = next(gate for gate in library.clock_gates if carries[gate] >= len(cluster))
                wires.append(f"  wire \\{CLOCK_GATE_PREFIX}{number}_clk")
                added += _gate(number, clock, enable, gate)
                for register in cluster:
                    body = lines[register.first:register.last + 1]
                    for offset, line in enumerate(body):
                        if cell := _CELL.match(line):
                            line = f"  cell {register.kind} {cell.group(2)}"
                        elif line.startswith("    connect \\C "):
                            line = f"    connect \\C \\{CLOCK_GATE_PREFIX}{number}_clk"
                        replaced[register.first + offset] = [] if line.startswith("    connect \\E ") else [line]
                number += 1
        replaced[begin] = [lines[begin], *wires]
        replaced[end] = [*added, "end"]
    return "\n".join(new for index, line in enumerate(lines) for new in replaced.get(index, [line])) + "\n", number


def insert(netlist: Path, library: Library) -> int:
    """Inserts clock gates into an RTLIL file if the library has a gate; returns their number."""
    if not library.clock_gates:
        return 0
    text, number = gated(netlist.read_text(encoding="utf-8"), library)
    netlist.write_text(text, encoding="utf-8")
    return number
