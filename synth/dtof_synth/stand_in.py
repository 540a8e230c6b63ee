# SPDX-License-Identifier: Apache-2.0
"""Stand-ins for most columns in the timed netlist: the logic at their borders.

A stand-in has every cell between an input port of the column and the first register, clock gate or macro behind the port. It also has every
cell between an output port and the last register, clock gate or macro in front of it; these end cells are included. So each path that
crosses a column's border is timed as in the whole array, and so is each path through a column from port to port. Paths that begin and end
inside a column are equal in all columns; the few real columns have them.

A cell that is left out still loads nets of the stand-in. It is replaced by load cells, which have a capacitance and no timing. Pins of
registers, clock gates and macros that such a cell would drive are not connected; `cut` names them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import netlist
from .liberty import THRESHOLDS, Group
from .library import Library
from .netlist import STUB, Module

LOAD = "column_load"
LOAD_PREFIX = "load_"
LOAD_PIN = "A"
LOADS_PER_FF = 100  # a load cell's name has its capacitance, in hundredths of a fF


@dataclass(frozen=True)
class StandIn:
    """A stand-in. `cut`: unconnected pins as cell/pin or cell/pin[bit]."""

    module: Module
    loads: dict[str, float]  # kind of load cell: fF
    cut: set[str]


class _Borders:
    """Decides which cells of a column stay."""

    def __init__(self, module: Module, library: Library) -> None:
        self.module = module
        self.library = library
        self.clocks = netlist.clock_nets(module)
        self.driver: dict[int, str] = {}
        self.sinks: dict[int, list[tuple[str, str]]] = {}
        for name, cell in module["cells"].items():
            for pin, bits in cell["connections"].items():
                for bit in bits:
                    if not isinstance(bit, int):
                        continue
                    if cell["port_directions"].get(pin) == "output":
                        self.driver[bit] = name
                    else:
                        self.sinks.setdefault(bit, []).append((name, pin))
        self.launching: set[str] = set()  # registers and so on whose outputs reach an output port
        self.kept: set[str] = set()
        self._backward(self._port_bits("output"))
        self._forward(self._port_bits("input"))
        self._clocked()

    def _port_bits(self, direction: str) -> list[int]:
        return [bit for port in self.module["ports"].values() if port["direction"] == direction
                for bit in port["bits"] if isinstance(bit, int) and bit not in self.clocks]

    def ends_paths(self, name: str) -> bool:
        """True for a register, a clock gate or a macro."""
        kind = self.module["cells"][name]["type"]
        return kind in self.library.sequential or kind in self.library.clock_pin_ff or kind not in self.library.area

    def drives(self, name: str | None) -> bool:
        """True if a cell keeps its outputs; a register that only ends a path does not."""
        return name is not None and name in self.kept and (not self.ends_paths(name) or name in self.launching)

    def _of(self, name: str, direction: str) -> Iterable[int]:
        cell = self.module["cells"][name]
        return (bit for pin, bits in cell["connections"].items() for bit in bits
                if isinstance(bit, int) and (cell["port_directions"].get(pin) == "output") == (direction == "output"))

    def _backward(self, waiting: list[int]) -> None:
        while waiting:
            name = self.driver.get(waiting.pop())
            if name is None or name in self.kept:
                continue
            self.kept.add(name)
            if self.ends_paths(name):
                self.launching.add(name)
            else:
                waiting += self._of(name, "input")

    def _forward(self, waiting: list[int]) -> None:
        seen: set[str] = set()
        while waiting:
            for name, _ in self.sinks.get(waiting.pop(), []):
                if name in seen:
                    continue
                seen.add(name)
                if not self.ends_paths(name):
                    waiting += self._of(name, "output")
        self.kept |= seen

    def _clocked(self) -> None:
        """Adds the clock gates in front of the cells that stay."""
        waiting = [bit for name in self.kept for bit in self._of(name, "input") if bit in self.clocks]
        while waiting:
            name = self.driver.get(waiting.pop())
            if name is not None and name not in self.launching:
                self.kept.add(name)
                self.launching.add(name)
                waiting += [bit for bit in self._of(name, "input") if bit in self.clocks]


def of(module: Module, library: Library, pin_load: Callable[[str, str], float]) -> StandIn:
    """The stand-in of a column."""
    borders = _Borders(module, library)
    inputs = {bit for port in module["ports"].values() if port["direction"] == "input" for bit in port["bits"]}
    cells: dict[str, dict] = {}
    cut: set[str] = set()
    for name, cell in module["cells"].items():
        if name not in borders.kept:
            continue
        connections = {}
        for pin, bits in cell["connections"].items():
            if cell["port_directions"].get(pin) == "output":
                if borders.drives(name):
                    connections[pin] = bits
                continue
            there = [not isinstance(bit, int) or bit in inputs or borders.drives(borders.driver.get(bit)) for bit in bits]
            if any(there) or module["cells"][name]["type"] not in library.area:  # a macro's pins are all connected
                connections[pin] = [bit if stays else "0" for bit, stays in zip(bits, there)]
            if borders.ends_paths(name):
                cut |= {f"{name}/{pin}" + (f"[{index}]" if len(bits) > 1 else "") for index, stays in enumerate(there) if not stays}
        cells[name] = {**cell, "connections": connections}
    driven = inputs | {bit for cell in cells.values() for pin, bits in cell["connections"].items()
                       if cell["port_directions"].get(pin) == "output" for bit in bits if isinstance(bit, int)}
    missing = {bit: [pin_load(module["cells"][name]["type"], pin) for name, pin in borders.sinks.get(bit, []) if name not in cells]
               for bit in sorted(driven - borders.clocks)}
    load_cells, loads = _load_cells(missing, library)
    return StandIn({"attributes": {}, "netnames": {}, "ports": module["ports"], "cells": cells | load_cells}, loads, cut)


def _load_cells(missing: dict[int, list[float]], library: Library) -> tuple[dict[str, dict], dict[str, float]]:
    """Load cells for the pins that are missing behind nets, and the kinds of load cells with their capacitance. `missing`: capacitances of
    a net's missing pins, fF."""
    cells: dict[str, dict] = {}
    loads: dict[str, float] = {}
    for bit, pins in missing.items():
        if pins:
            # Each had its piece of wire, and so has the load cell.
            hundredths = round((sum(pins) + (len(pins) - 1) * library.wire_ff_per_sink) * LOADS_PER_FF)
            kind = f"{LOAD_PREFIX}{hundredths}"
            loads[kind] = hundredths / LOADS_PER_FF
            cells[f"{LOAD_PREFIX}{bit}"] = {"hide_name": 0, "type": kind, "parameters": {}, "attributes": {},
                                            "port_directions": {LOAD_PIN: "input"}, "connections": {LOAD_PIN: [bit]}}
    return cells, loads


def load_of(module: Module, library: Library, pin_load: Callable[[str, str], float]) -> StandIn:
    """A column reduced to the load of its input ports, without paths."""
    inputs = {bit for port in module["ports"].values() if port["direction"] == "input" for bit in port["bits"] if isinstance(bit, int)}
    nets = netlist.sinks_of(module, pin_load, 0.0)
    missing = {bit: [sink.load for sink in nets[bit]] for bit in sorted(inputs - netlist.clock_nets(module)) if bit in nets}
    cells, loads = _load_cells(missing, library)
    return StandIn({"attributes": {}, "netnames": {}, "ports": module["ports"], "cells": cells}, loads, set())


def timed(design: dict, real: Iterable[str], library: Library, pin_load: Callable[[str, str], float],
          bordered: Iterable[str] | None = None) -> tuple[dict, StandIn]:
    """The design with stand-ins for all columns except `real`. With `bordered`, only these columns get stand-ins, the others mere loads.
    Unchanged modules and cells are shared with the design."""
    kind = netlist.column_module(design)
    module = netlist.modules(design)[kind]
    stand_in, load = of(module, library, pin_load), load_of(module, library, pin_load)
    array, stay = netlist.top(design), set(real)
    stand = None if bordered is None else set(bordered)

    def typed(name: str, cell: dict) -> dict:
        if cell["type"] != kind or name in stay:
            return cell
        return {**cell, "type": STUB if stand is None or name in stand else LOAD}

    changed = {**array, "cells": {name: typed(name, cell) for name, cell in array["cells"].items()},
               "netnames": dict(array["netnames"])}
    modules = {name: changed if module is array else module for name, module in netlist.modules(design).items()}
    modules |= {STUB: stand_in.module} | ({LOAD: load.module} if stand is not None else {})
    return {**design, "modules": modules}, StandIn(stand_in.module, stand_in.loads | load.loads, stand_in.cut)


def liberty(stand_in: StandIn, voltage: float) -> str:
    """Liberty of the load cells."""
    library = Group("library", ["stand_in"], [("delay_model", "table_lookup"), ("time_unit", '"1ns"'), ("voltage_unit", '"1V"'),
                                              ("current_unit", '"1mA"'), ("capacitive_load_unit", ["1", "ff"]),
                                              ("nom_voltage", f"{voltage}"), *THRESHOLDS])
    for kind, load in sorted(stand_in.loads.items()):
        cell = library.add(Group("cell", [kind], [("area", "0")]))
        cell.add(Group("pin", [LOAD_PIN], [("direction", "input"), ("capacitance", f"{load:.2f}")]))
    return library.write() + "\n"
