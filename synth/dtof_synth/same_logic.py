# SPDX-License-Identifier: Apache-2.0
"""Checks that the steps after mapping keep the logic: they may insert buffers, copy registers and change drives. Everything else in the
counted and timed netlist must be as mapped, and as `make sim-netlist` simulates it.

The logic of a module is, for each cell that is no buffer, its function and the sources of its inputs, and the source of each output of the
module. Sources are found by looking through buffers and by taking the original in place of a copied register.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from . import netlist
from .errors import FlowError
from .library import Library
from .netlist import COPY_SUFFIX, Module

Source = tuple[str, ...]
Bit = int | str  # a net, or a constant as Yosys writes it
Logic = dict[str, dict[str, tuple]]  # of each module: what its cells and outputs are, by name


@dataclass(frozen=True)
class _Reader:
    """Logic of one module. `name_of`: name of each cell when it was mapped."""

    module: Module
    library: Library
    name_of: Callable[[str], str]
    family: Mapping[str, str]

    def _original(self, cell: str) -> str:
        """The cell of which this cell is a copy, or the cell itself."""
        return re.sub(rf"{COPY_SUFFIX}\d+$", "", self.name_of(cell))

    def read(self) -> dict[str, tuple]:
        buffers = {buffer.name for buffer in self.library.buffers}
        passed: dict[Bit, Bit] = {}  # what a buffer's output repeats
        source: dict[Bit, Source] = {}
        for port, description in self.module["ports"].items():
            if description["direction"] == "input":
                source.update((bit, ("port", port, str(index))) for index, bit in enumerate(description["bits"]))
        for cell, description in self.module["cells"].items():
            pins = description["connections"]
            outputs = [pin for pin in pins if description["port_directions"].get(pin) == "output"]
            if description["type"] in buffers:
                inputs = next(bits for pin, bits in pins.items() if pin not in outputs)
                passed[pins[outputs[0]][0]] = inputs[0]
                continue
            for pin in outputs:
                source.update((bit, (self._original(cell), pin, str(index))) for index, bit in enumerate(pins[pin]))

        def root(bit: Bit) -> Source:
            while bit in passed:
                bit = passed[bit]
            return source.get(bit, (str(bit) if isinstance(bit, str) else "nothing",))

        found: dict[str, tuple] = {}
        for cell, description in self.module["cells"].items():
            kind = description["type"]
            if kind in buffers:
                continue
            original = self._original(cell)
            inputs = tuple(sorted((pin, tuple(root(bit) for bit in bits)) for pin, bits in description["connections"].items()
                                  if description["port_directions"].get(pin) != "output"))
            logic = (self.family.get(kind, kind), inputs)
            if found.setdefault(original, logic) != logic:
                raise FlowError(f"{original} and its copy {self.name_of(cell)} do not hear the same")
        for port, description in self.module["ports"].items():
            if description["direction"] == "output":
                found[f"output {port}"] = tuple(root(bit) for bit in description["bits"])
        return found


def _called(names: Mapping[str, str]) -> Callable[[str], str]:
    return lambda cell: names.get(cell, cell)


def of(design: dict, library: Library, called: Mapping[str, Mapping[str, str]] | None = None) -> Logic:
    """Logic of a design. `called`: names of each module's cells when they were mapped, if they have changed. FlowError if a copy of a
    register differs from its original."""
    family = {kind: kinds[0] for kinds in library.drives for kind in kinds}
    logic: Logic = {}
    for name, module in netlist.modules(design).items():
        if module["cells"]:
            logic[name] = _Reader(module, library, _called((called or {}).get(name, {})), family).read()
    return logic


def check(mapped: Logic, finished: Logic) -> None:
    """FlowError that names the first difference, if there is one."""
    for module in sorted(mapped.keys() | finished.keys()):
        before, after = mapped.get(module, {}), finished.get(module, {})
        for name in sorted(before.keys() | after.keys()):
            if before.get(name) != after.get(name):
                what = "is new" if name not in before else "is gone" if name not in after else "is no longer what was mapped"
                raise FlowError(f"{module}: {name} {what}")
