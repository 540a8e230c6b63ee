# SPDX-License-Identifier: Apache-2.0
"""Registers on the way between the shared logic and the blocks (columns and engines) in arrays with more than two BROADCAST_STAGES.

A signal to the blocks goes through `stages` registers in a row (hdl/common/dtof_broadcast.sv). The first one is beside the shared logic, and the
copies of the last one are beside the blocks. The registers between them have a number, 2 to stages - 1. A block's result goes through up to
stages - 2 registers in a row, which have their places on the way back.

Registers are found by their connections, not by their names: Yosys merges registers that are equal, and then one register has the name of the
sequencer's.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping

from .netlist import Module

DATA, OUTPUT = "D", "Q"


class Registers:
    """Registers of a module in rows: each takes what the one before it has, without logic between them."""

    def __init__(self, module: Module, sequential: set[str], gated: Container[int] = frozenset()) -> None:
        """`gated`: clock nets behind clock gates. Registers on them are no part of a row, because a copy would load its gate."""
        self.output: dict[str, int] = {}  # net of each register
        self.data: dict[str, int] = {}
        for name, cell in module["cells"].items():
            pins = cell["connections"]
            if cell["type"] in sequential and DATA in pins and OUTPUT in pins and isinstance(pins[DATA][0], int) and not any(
                    bit in gated for bits in pins.values() for bit in bits):
                self.output[name], self.data[name] = pins[OUTPUT][0], pins[DATA][0]
        self.driver = {net: name for name, net in self.output.items()}
        self.behind: dict[int, list[str]] = {}  # registers that take a net as it is
        for name, net in self.data.items():
            self.behind.setdefault(net, []).append(name)

    def _before(self, net: int) -> int:
        """What the register of a net takes; 0 if the net is no register's."""
        return self.data[self.driver[net]] if net in self.driver else 0

    def numbers(self, last: Iterable[int], stages: int) -> dict[int, int]:
        """The number of each register between the first and the last one, by its net. `last`: nets of the last registers. A register of
        several rows has its largest number. One that takes what a gate gives has none: it stays beside the gate."""
        last = set(last)
        found: dict[int, int] = {}
        for net in sorted(last):
            for number in range(stages - 1, 1, -1):
                net = self._before(net)
                if self._before(net) not in self.driver:
                    break
                if net not in last:
                    found[net] = max(number, found.get(net, 0))
        return found

    def _row(self, register: str, placed: Container[str], most: int) -> list[str]:
        """Registers in a row from this one on that have no place yet, as far as a register is all that follows."""
        row: list[str] = []
        following = [register]
        while len(row) < most and len(following) == 1 and following[0] not in row and following[0] not in placed:
            row += following
            following = self.behind.get(self.output[row[-1]], [])
        return row

    def results(self, blocks: Mapping[int, float], placed: Container[str], centre_um: float, stages: int) -> dict[str, float]:
        """Places of the registers that take a block's output, evenly over the way to the middle. `blocks`: places by the blocks' nets;
        `placed`: registers that have a place."""
        found: dict[str, float] = {}
        for net, start in blocks.items():
            for register in self.behind.get(net, []):
                row = self._row(register, placed, stages - 2)
                found |= {name: start + (centre_um - start) * number / (len(row) + 1) for number, name in enumerate(row, 1)}
        return found
