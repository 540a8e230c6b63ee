# SPDX-License-Identifier: Apache-2.0
"""Mapped netlists as Yosys writes them in JSON: counts, fan-out trees, and the reduced array for timing.

The array is synthesised as it is, instances of one column module (of one column, or two that share an SRAM). A net that drives more than its
driver can is given a tree of buffers, so that the broadcast from the shared logic to all columns is counted
and timed. For timing, all but a few columns are replaced by stubs with the same input load.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import astuple, dataclass

from .errors import FlowError
from .liberty import THRESHOLDS, Group, bus_type
from .library import Buffer, Library

Module = dict
COLUMN_SUFFIXES = ("_column", "_pair")
ENGINE_SUFFIX = "_engine"
STUB = "column_stub"
TREE_PREFIX = "fanout_"
COPY_SUFFIX = "_copy"
CLOCK_GATE_PREFIX = "clock_gate_"  # instances that clock_gating.py put in
# A driver is given a tree when its load exceeds this share of its max_capacitance; trees fill to it.
TREE_LOAD_SHARE = 0.5


@dataclass(frozen=True)
class Counts:
    """Cells of one module (its columns and macros apart)."""

    cells: int
    flip_flops: int
    area: float
    buffers: int
    buffer_area: float
    clock_ff: float  # of what the clock tree feeds: flip-flops that are not gated, and gates
    clock_energy_fj: float  # in a clock cycle, of the same
    clock_sinks: int = 0  # how many they are

    def share(self, columns: int) -> Counts:
        """What one of a module's columns has of it."""
        return self if columns == 1 else Counts(
            *(round(value / columns) if isinstance(value, int) else value / columns for value in astuple(self)))


def modules(design: dict) -> dict[str, Module]:
    return design["modules"]


def column_module(design: dict) -> str:
    """Name of the one column module; FlowError if there is not exactly one kind."""
    used = _kinds(design, COLUMN_SUFFIXES)
    if len(used) != 1:
        raise FlowError(f"the array has {len(used)} kinds of columns instead of one: {sorted(used)}")
    return used.pop()


def engine_module(design: dict) -> str:
    """Name of the module that several columns share, if there is one; FlowError if there are several kinds."""
    used = _kinds(design, (ENGINE_SUFFIX,))
    if len(used) > 1:
        raise FlowError(f"the array has {len(used)} kinds of engines instead of one: {sorted(used)}")
    return used.pop() if used else ""


def _kinds(design: dict, suffixes: tuple[str, ...]) -> set[str]:
    return {cell["type"] for cell in top(design)["cells"].values() if cell["type"].endswith(suffixes)}


def top(design: dict) -> Module:
    for module in modules(design).values():
        if int(module["attributes"].get("top", "0"), 2):
            return module
    raise FlowError("the netlist has no top module")


def rename_parts(design: dict) -> None:
    """Gives the derived column and engine modules their plain names, which every tool reads."""
    for old in filter(None, (column_module(design), engine_module(design))):
        plain = old.split("\\")[-1]
        modules(design)[plain] = modules(design).pop(old)
        for cell in top(design)["cells"].values():
            if cell["type"] == old:
                cell["type"] = plain


def count(module: Module, library: Library) -> Counts:
    kinds = Counter(cell["type"] for cell in module["cells"].values())
    trees = Counter(cell["type"] for name, cell in module["cells"].items() if name.startswith(TREE_PREFIX))
    flops = {kind: number for kind, number in kinds.items() if kind in library.sequential}
    gated = clock_nets(module) - port_clock_nets(module)
    fed = Counter(cell["type"] for cell in module["cells"].values() if cell["type"] in library.clock_pin_ff
                  and not any(bit in gated for pin, bits in cell["connections"].items()
                              if cell["port_directions"].get(pin) == "input" for bit in bits))
    return Counts(sum(number for kind, number in kinds.items() if kind in library.area),
                  sum(flops.values()),
                  sum(library.area.get(kind, 0) * number for kind, number in kinds.items()),
                  sum(trees.values()),
                  sum(library.area[kind] * number for kind, number in trees.items()),
                  sum(library.clock_pin_ff[kind] * number for kind, number in fed.items()),
                  sum(library.clock_energy_fj[kind] * number for kind, number in fed.items()),
                  sum(fed.values()))


def count_engines(design: dict, library: Library) -> Counts:
    """All engines together; nothing where the array has none."""
    engine = engine_module(design)
    number = sum(cell["type"] == engine for cell in top(design)["cells"].values())
    one = count(modules(design)[engine], library) if number else Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)
    return Counts(*(number * value for value in astuple(one)))


def count_shared(design: dict, library: Library) -> Counts:
    """Everything outside the columns: the top and its engines."""
    return Counts(*(a + b for a, b in zip(astuple(count(top(design), library)),
                                          astuple(count_engines(design, library)))))


def foreign_cells(design: dict, library: Library, macros: set[str]) -> set[str]:
    """Cell types that are neither library cells, macros nor modules of the design."""
    found = {cell["type"] for module in modules(design).values() for cell in module["cells"].values()}
    return found - set(library.area) - macros - {name for name, module in modules(design).items()
                                                 if module["cells"]}


@dataclass
class _Sink:
    """One load of a net: the connection list and index to rewire, and its capacitance."""

    bits: list
    index: int
    load: float


def _sinks(module: Module, pin_load: Callable[[str, str], float], wire: float) -> dict[int, list[_Sink]]:
    nets: dict[int, list[_Sink]] = {}
    for cell in module["cells"].values():
        for pin, bits in cell["connections"].items():
            if cell["port_directions"].get(pin) == "output":
                continue
            load = pin_load(cell["type"], pin) + wire
            for index, bit in enumerate(bits):
                if isinstance(bit, int):
                    nets.setdefault(bit, []).append(_Sink(bits, index, load))
    return nets


def _drivers(module: Module, library: Library, port_drive: float) -> Iterator[tuple[int, float]]:
    """(net, load the driver takes) of every driven net; an input port drives like the smallest buffer."""
    for port in module["ports"].values():
        if port["direction"] == "input":
            yield from ((bit, port_drive) for bit in port["bits"] if isinstance(bit, int))
    for cell in module["cells"].values():
        for pin, bits in cell["connections"].items():
            if cell["port_directions"].get(pin) == "output":
                limit = library.max_load_ff.get(cell["type"], {}).get(pin, 0.0) or port_drive
                yield from ((bit, limit) for bit in bits if isinstance(bit, int))


def _next_net(module: Module) -> int:
    used = [bit for port in module["ports"].values() for bit in port["bits"] if isinstance(bit, int)]
    used += [bit for cell in module["cells"].values() for bits in cell["connections"].values()
             for bit in bits if isinstance(bit, int)]
    return max(used, default=1) + 1


def _clusters(sinks: list[_Sink], limit: float) -> list[list[_Sink]]:
    """As few clusters as the limit allows, evenly filled."""
    total = sum(sink.load for sink in sinks)
    share = total / max(1, -(-total // limit))
    clusters: list[list[_Sink]] = [[]]
    filled = 0.0
    for sink in sinks:
        if clusters[-1] and filled + sink.load > share * 1.0001:
            clusters.append([])
            filled = 0.0
        clusters[-1].append(sink)
        filled += sink.load
    return clusters


def _smallest(buffers: list[Buffer], load: float) -> Buffer:
    return next((buffer for buffer in buffers if buffer.max_load_ff * TREE_LOAD_SHARE >= load), buffers[-1])


class _TreeBuilder:
    """Adds buffers and register copies to one module."""

    def __init__(self, module: Module, library: Library, pin_load: Callable[[str, str], float]) -> None:
        self.module = module
        self.buffers = library.buffers
        self.wire = library.wire_ff_per_sink
        self.library = library
        self.pin_load = pin_load
        self.nets = _sinks(module, pin_load, self.wire)
        self.fresh = _next_net(module)
        self.drivers = {bits[0]: name for name, cell in module["cells"].items()
                        for pin, bits in cell["connections"].items()
                        if cell["port_directions"].get(pin) == "output" and len(bits) == 1}

    def _rewire(self, cluster: list[_Sink]) -> int:
        for sink in cluster:
            sink.bits[sink.index] = self.fresh
        self.fresh += 1
        return self.fresh - 1

    def _buffer(self, net: int, cluster: list[_Sink]) -> _Sink:
        """Puts the smallest sufficient buffer between a net and a cluster of its sinks."""
        buffer = _smallest(self.buffers, _load(cluster))
        output = self._rewire(cluster)
        cell = {"hide_name": 0, "type": buffer.name, "parameters": {}, "attributes": {},
                "port_directions": {buffer.input_pin: "input", buffer.output_pin: "output"},
                "connections": {buffer.input_pin: [net], buffer.output_pin: [output]}}
        self.module["cells"][f"{TREE_PREFIX}{net}_{output}"] = cell
        return _Sink(cell["connections"][buffer.input_pin], 0, buffer.input_ff + self.wire)

    def _copy_register(self, net: int, cluster: list[_Sink]) -> None:
        """Gives a cluster its own copy of the register that drives the net."""
        original = self.module["cells"][self.drivers[net]]
        output = self._rewire(cluster)
        pins = {pin: list(bits) for pin, bits in original["connections"].items()
                if original["port_directions"][pin] == "input"}
        out = next(pin for pin, bits in original["connections"].items() if bits == [net])
        self.module["cells"][f"{self.drivers[net]}{COPY_SUFFIX}{output}"] = {
            **original, "connections": {**pins, out: [output]}}
        for pin, bits in pins.items():
            load = self.pin_load(original["type"], pin) + self.wire
            self.nets.setdefault(bits[0], []).append(_Sink(bits, 0, load))

    def relieve(self, net: int, maximum: float, far: list[_Sink], copy: bool) -> None:
        """Takes load off a net until its driver can carry it. `far` sinks go behind the tree, light ones stay
        with the driver; `copy` replaces the root of the tree by copies of the driving register."""
        limit = maximum * TREE_LOAD_SHARE
        near = [sink for sink in self.nets[net] if all(sink is not other for other in far)]
        if _load(near) > limit / 2:
            far, near = self.nets[net], []
        room = limit - _load(near)
        leaf = self.buffers[-1].max_load_ff * TREE_LOAD_SHARE
        sinks, first = far, True
        while len(sinks) > 1 and _load(sinks) > room:
            parents = [self._buffer(net, cluster) for cluster in _clusters(sinks, leaf)]
            if copy and first and len(parents) > 1:
                for cluster in _clusters(parents, limit):
                    self._copy_register(net, cluster)
                parents = []
            first = False
            if len(parents) == len(sinks):
                break
            sinks = parents
        self.nets[net] = near + sinks


def _load(sinks: list[_Sink]) -> float:
    return sum(sink.load for sink in sinks)


def insert_fanout_trees(module: Module, library: Library, pin_load: Callable[[str, str], float],
                        skip: set[int], far_module: str = "") -> None:
    """Relieves every overloaded net of a module. `skip` are clock nets. Sinks on instances of `far_module`
    (the columns, spread over the die) go behind the tree; a register that broadcasts to them is copied."""
    builder = _TreeBuilder(module, library, pin_load)
    far_bits = {id(bits) for cell in module["cells"].values() if cell["type"] == far_module
                for bits in cell["connections"].values()}
    drivers = dict(_drivers(module, library, library.buffers[0].max_load_ff))
    registers = {net for net, name in builder.drivers.items()
                 if module["cells"][name]["type"] in library.sequential}
    # Registers first: copies add load to the nets before them.
    for net in sorted(drivers, key=lambda net: net not in registers):
        sinks = builder.nets.get(net, [])
        if net in skip or _load(sinks) <= drivers[net] * TREE_LOAD_SHARE:
            continue
        far = [sink for sink in sinks if id(sink.bits) in far_bits]
        builder.relieve(net, drivers[net], far or sinks, copy=bool(far) and net in registers)


def port_clock_nets(module: Module) -> set[int]:
    return {bit for name, port in module["ports"].items() if name.startswith("clk") for bit in port["bits"]}


def clock_nets(module: Module) -> set[int]:
    """Of the ports, and those behind clock gates."""
    return port_clock_nets(module) | {bit for name, cell in module["cells"].items() if name.startswith(CLOCK_GATE_PREFIX)
                                      for pin, bits in cell["connections"].items()
                                      if cell["port_directions"].get(pin) == "output" for bit in bits}


def port_loads(module: Module, pin_load: Callable[[str, str], float], wire: float) -> dict[str, list[float]]:
    """Load behind each bit of each input port, fF."""
    nets = _sinks(module, pin_load, wire)
    return {name: [sum(sink.load for sink in nets.get(bit, [])) if isinstance(bit, int) else 0.0
                   for bit in port["bits"]]
            for name, port in module["ports"].items() if port["direction"] == "input"}


def finish(design: dict, library: Library, macro_pin_ff: float) -> dict[str, list[float]]:
    """Inserts the fan-out trees of column, engine and top; returns the load of the column's input ports."""
    wire = library.wire_ff_per_sink
    name = column_module(design)
    mean: dict[str, dict[str, float]] = {}

    def cell_load(kind: str, pin: str) -> float:
        return library.input_ff[kind].get(pin, 0.0) if kind in library.input_ff else macro_pin_ff

    for part in filter(None, (engine_module(design), name)):
        module = modules(design)[part]
        insert_fanout_trees(module, library, cell_load, clock_nets(module))
        loads = port_loads(module, cell_load, wire)
        mean[part] = {port: max(values, default=0.0) for port, values in loads.items()}

    def top_load(kind: str, pin: str) -> float:
        return mean[kind].get(pin, 0.0) if kind in mean else cell_load(kind, pin)

    array = top(design)
    insert_fanout_trees(array, library, top_load, clock_nets(array), name)
    return loads


def cell_kinds(design: dict, library: Library) -> set[str]:
    """Library cells that the design uses."""
    used = {cell["type"] for module in modules(design).values() for cell in module["cells"].values()}
    return used & set(library.area)


def prepare_simulation(design: dict, library: Library, suffix: str, power_up: str,
                       draw: Callable[[], bool]) -> None:
    """Gives the design's own modules a suffix, so that the RTL's can stand beside them, and every register a state
    at time 0 in its parameter `power_up`. Registers of one module power up alike in all its instances."""
    own = {name for name, module in modules(design).items() if module["cells"]}
    for name in own:
        module = modules(design).pop(name)
        modules(design)[name + suffix] = module
        for cell in module["cells"].values():
            if cell["type"] in own:
                cell["type"] += suffix
            elif cell["type"] in library.sequential:
                cell["parameters"] = {power_up: "1" if draw() else "0"}


def keep_columns(design: dict, kept: int) -> None:
    """Replaces all columns but the first `kept - 1` and the last by stubs of the same load."""
    name = column_module(design)
    columns = [cell for cell in top(design)["cells"].values() if cell["type"] == name]
    for cell in columns[max(kept - 1, 1):-1]:
        cell["type"] = STUB
    stub = {"attributes": {"blackbox": "1"}, "cells": {}, "netnames": {},
            "ports": modules(design)[name]["ports"]}
    modules(design)[STUB] = stub


def stub_liberty(design: dict, loads: dict[str, list[float]], voltage: float) -> str:
    """Liberty of the stub: the column's ports with their loads, no arcs."""
    library = Group("library", [STUB], [("delay_model", "table_lookup"), ("time_unit", '"1ns"'),
                                        ("voltage_unit", '"1V"'), ("current_unit", '"1mA"'),
                                        ("capacitive_load_unit", ["1", "ff"]),
                                        ("nom_voltage", f"{voltage}"), *THRESHOLDS])
    ports = modules(design)[column_module(design)]["ports"]
    spans = {(len(port["bits"]), port.get("offset", 0)) for port in ports.values()}
    library.groups += [bus_type(width, offset) for width, offset in sorted(spans)]
    cell = library.add(Group("cell", [STUB], [("area", "0"), ("interface_timing", "true")]))
    for port, description in ports.items():
        width, offset = len(description["bits"]), description.get("offset", 0)
        load = max(loads.get(port, [0.0]))
        attributes: list[tuple[str, str | list[str]]] = [("direction", description["direction"])]
        if description["direction"] == "input":
            attributes.append(("capacitance", f"{load:.4f}"))
        if width == 1 and not offset:
            cell.add(Group("pin", [port], attributes))
        else:
            cell.add(Group("bus", [port], [("bus_type", f"bits_{width}_{offset}"), *attributes]))
    return library.write() + "\n"
