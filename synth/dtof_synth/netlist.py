# SPDX-License-Identifier: Apache-2.0
"""Mapped netlists in Yosys's JSON: counts, fan-out trees, and the reduced array for timing.

The array is synthesised as it is, with instances of one column module (of one column, or of the columns that share an SRAM). A net whose
load exceeds its driver's limit gets a tree of buffers. Between the shared logic and the columns, trees follow the floorplan (floorplan.py),
so that the broadcast is counted and timed with its wires. For timing, all but a few columns are replaced by the logic at their borders
(stand_in.py).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import astuple, dataclass

from .errors import FlowError
from .library import Buffer, Library

Module = dict
COLUMN_SUFFIXES = ("_column", "_quad")
ENGINE_SUFFIX = "_engine"
STUB = "column_stand_in"
TOP = "top"  # kind of block of what is outside all of them
TREE_PREFIX = "fanout_"
COPY_SUFFIX = "_copy"
HOLD_PREFIX = "hold_"
CLOCK_GATE_PREFIX = "clock_gate_"  # instances that clock_gating.py put in
# A driver is given a tree when its load exceeds this share of its max_capacitance; trees fill to it.
TREE_LOAD_SHARE = 0.5
MAX_FANOUT = 200  # inputs of a net, at whatever load


@dataclass(frozen=True)
class Counts:
    """Cells of one module, without its columns and macros."""

    cells: int
    flip_flops: int
    area: float
    buffers: int
    buffer_area: float
    clock_ff: float  # of what the clock tree feeds: flip-flops that are not gated, and gates
    clock_energy_fj: float  # in a clock cycle, of the same
    clock_sinks: int = 0  # how many they are

    def share(self, columns: int) -> Counts:
        """Share of each of `columns` columns in these counts."""
        return self if columns == 1 else Counts(
            *(round(value / columns) if isinstance(value, int) else value / columns for value in astuple(self)))


def modules(design: dict) -> dict[str, Module]:
    return design["modules"]


def column_module(design: dict) -> str:
    """Name of the column module. FlowError unless there is exactly one kind."""
    used = _kinds(design, COLUMN_SUFFIXES)
    if len(used) != 1:
        raise FlowError(f"the array has {len(used)} kinds of columns instead of one: {sorted(used)}")
    return used.pop()


def columns(design: dict) -> list[str]:
    """Names of the instances of the column module."""
    kind = column_module(design)
    return [name for name, cell in top(design)["cells"].items() if cell["type"] == kind]


def engine_module(design: dict) -> str:
    """Name of the module that several columns share, if there is one. FlowError if there are several kinds."""
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
    """Gives the derived column and engine modules their plain names, which every tool can read."""
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
    """Cells of all engines together; empty without engines."""
    engine = engine_module(design)
    number = sum(cell["type"] == engine for cell in top(design)["cells"].values())
    one = count(modules(design)[engine], library) if number else Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)
    return Counts(*(number * value for value in astuple(one)))


def count_shared(design: dict, library: Library) -> Counts:
    """Cells outside the columns: the top and its engines."""
    return Counts(*(a + b for a, b in zip(astuple(count(top(design), library)),
                                          astuple(count_engines(design, library)))))


def foreign_cells(design: dict, library: Library, macros: set[str]) -> set[str]:
    """Cell types that are neither library cells, macros nor modules of the design."""
    found = {cell["type"] for module in modules(design).values() for cell in module["cells"].values()}
    return found - set(library.area) - macros - {name for name, module in modules(design).items()
                                                 if module["cells"]}


@dataclass
class Sink:
    """A load of a net: cell, connection list and index to rewire, and capacitance."""

    cell: str
    bits: list
    index: int
    load: float


def sinks_of(module: Module, pin_load: Callable[[str, str], float], wire: float) -> dict[int, list[Sink]]:
    """Loads of every net. `wire`: wire capacitance of each load."""
    nets: dict[int, list[Sink]] = {}
    for name, cell in module["cells"].items():
        for pin, bits in cell["connections"].items():
            if cell["port_directions"].get(pin) == "output":
                continue
            load = pin_load(cell["type"], pin) + wire
            for index, bit in enumerate(bits):
                if isinstance(bit, int):
                    nets.setdefault(bit, []).append(Sink(name, bits, index, load))
    return nets


def drivers_of(module: Module, library: Library, port_drive: float) -> Iterator[tuple[int, float]]:
    """(net, largest load of its driver) for every driven net; an input port drives like the smallest buffer."""
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


def clusters(sinks: list[Sink], limit: float) -> list[list[Sink]]:
    """Divides sinks into the fewest clusters within the limit, of nearly equal loads."""
    total = sum(sink.load for sink in sinks)
    share = total / max(1, -(-total // limit))
    clusters: list[list[Sink]] = [[]]
    filled = 0.0
    for sink in sinks:
        if clusters[-1] and (filled + sink.load > share * 1.0001 or len(clusters[-1]) == MAX_FANOUT):
            clusters.append([])
            filled = 0.0
        clusters[-1].append(sink)
        filled += sink.load
    return clusters


def _smallest(buffers: list[Buffer], load: float) -> Buffer:
    return next((buffer for buffer in buffers if buffer.max_load_ff * TREE_LOAD_SHARE >= load), buffers[-1])


class TreeBuilder:
    """Adds buffers and register copies to one module."""

    def __init__(self, module: Module, library: Library, pin_load: Callable[[str, str], float]) -> None:
        self.module = module
        self.buffers = library.buffers
        self.wire = library.wire_ff_per_sink
        self.library = library
        self.pin_load = pin_load
        self.nets = sinks_of(module, pin_load, self.wire)
        self.fresh = _next_net(module)
        self.drivers = {bits[0]: name for name, cell in module["cells"].items()
                        for pin, bits in cell["connections"].items()
                        if cell["port_directions"].get(pin) == "output" and len(bits) == 1}

    def _rewire(self, cluster: list[Sink]) -> int:
        for sink in cluster:
            sink.bits[sink.index] = self.fresh
        self.fresh += 1
        return self.fresh - 1

    def buffer(self, net: int, cluster: list[Sink], wire_ff: float = 0.0) -> Sink:
        """Inserts in front of a cluster of a net's sinks the smallest buffer that can drive them and a wire."""
        buffer = _smallest(self.buffers, load_of(cluster) + wire_ff)
        output = self._rewire(cluster)
        name = f"{TREE_PREFIX}{net}_{output}"
        connections = {buffer.input_pin: [net], buffer.output_pin: [output]}
        self.module["cells"][name] = {
            "hide_name": 0, "type": buffer.name, "parameters": {}, "attributes": {},
            "port_directions": {buffer.input_pin: "input", buffer.output_pin: "output"}, "connections": connections}
        return Sink(name, connections[buffer.input_pin], 0, buffer.input_ff + self.wire)

    def copy_register(self, net: int, cluster: list[Sink]) -> tuple[str, int]:
        """Copies the register that drives the net for a cluster; returns the copy's name and net."""
        original = self.module["cells"][self.drivers[net]]
        output = self._rewire(cluster)
        pins = {pin: list(bits) for pin, bits in original["connections"].items()
                if original["port_directions"][pin] == "input"}
        out = next(pin for pin, bits in original["connections"].items() if bits == [net])
        name = f"{self.drivers[net]}{COPY_SUFFIX}{output}"
        self.module["cells"][name] = {**original, "connections": {**pins, out: [output]}}
        for pin, bits in pins.items():
            load = self.pin_load(original["type"], pin) + self.wire
            self.nets.setdefault(bits[0], []).append(Sink(name, bits, 0, load))
        self.nets[output] = cluster
        return name, output

    def relieve(self, net: int, maximum: float) -> None:
        """Reduces the load of a net until its driver can carry it."""
        limit = maximum * TREE_LOAD_SHARE
        leaf = self.buffers[-1].max_load_ff * TREE_LOAD_SHARE
        sinks = self.nets[net]
        while len(sinks) > 1 and (load_of(sinks) > limit or len(sinks) > MAX_FANOUT):
            parents = [self.buffer(net, cluster) for cluster in clusters(sinks, leaf)]
            if len(parents) == len(sinks):
                break
            sinks = parents
        self.nets[net] = sinks


def load_of(sinks: list[Sink]) -> float:
    return sum(sink.load for sink in sinks)


def strengthen(module: Module, library: Library, pin_load: Callable[[str, str], float], skip: set[int]) -> None:
    """Replaces a cell that is too weak for its load by one with enough drive, if that costs less than a buffer."""
    nets = sinks_of(module, pin_load, library.wire_ff_per_sink)
    family = {kind: kinds for kinds in library.drives for kind in kinds}
    for cell in module["cells"].values():
        kind = cell["type"]
        loads = {pin: load_of(nets.get(bits[0], [])) for pin, bits in cell["connections"].items()
                 if cell["port_directions"].get(pin) == "output"}
        if kind not in family or any(bits[0] in skip for pin, bits in cell["connections"].items() if pin in loads):
            continue
        most = library.area[kind] + library.buffers[0].area
        cell["type"] = next((drive for drive in family[kind][family[kind].index(kind):] if library.area[drive] <= most and all(
            load <= library.max_load_ff[drive][pin] * TREE_LOAD_SHARE for pin, load in loads.items())), kind)


def insert_fanout_trees(module: Module, library: Library, pin_load: Callable[[str, str], float],
                        skip: set[int]) -> None:
    """Inserts buffers for every overloaded net of a module whose cells are close to each other. `skip`: clock nets."""
    strengthen(module, library, pin_load, skip)
    builder = TreeBuilder(module, library, pin_load)
    for net, maximum in list(drivers_of(module, library, library.buffers[0].max_load_ff)):
        sinks = builder.nets.get(net, [])
        if net not in skip and (load_of(sinks) > maximum * TREE_LOAD_SHARE or len(sinks) > MAX_FANOUT):
            builder.relieve(net, maximum)


def port_clock_nets(module: Module) -> set[int]:
    return {bit for name, port in module["ports"].items() if name.startswith("clk") for bit in port["bits"]}


def local_pin(design: dict, name: str) -> tuple[str, str, str]:
    """(kind of block, cell, pin) of a pin named as OpenSTA does: [block/]cell/pin or pin[bit]. The top's kind is empty."""
    *block, cell, pin = name.split("/")
    return top(design)["cells"][block[0]]["type"] if block else "", cell, pin


def in_all_blocks(design: dict, pin: tuple[str, str, str]) -> list[str]:
    """OpenSTA's names of a pin (local_pin), one for each block of its kind."""
    kind, cell, name = pin
    blocks = [f"{block}/" for block, other in top(design)["cells"].items() if other["type"] == kind] if kind else [""]
    return [f"{block}{cell}/{name}" for block in blocks]


def has_pin(design: dict, name: str) -> bool:
    """True if a pin named as in OpenSTA exists and is connected."""
    kind, cell, pin = local_pin(design, name)
    cells = (modules(design)[kind] if kind else top(design))["cells"]
    return cell in cells and pin.split("[")[0] in cells[cell]["connections"]


def _bits_of(module: Module, cell: str, pin: str) -> tuple[list, int]:
    """Connection of a pin named as in OpenSTA: the list, and the index in it."""
    index = int(pin[pin.index("[") + 1:-1]) if "[" in pin else 0
    return module["cells"][cell]["connections"][pin.split("[")[0]], index


def delay_pins(design: dict, buffers: dict[tuple[str, str, str], int], library: Library) -> dict[str, str]:
    """Inserts the given number of smallest buffers in front of each pin (local_pin); pins of one net share them. All blocks of a kind are
    delayed alike. Returns, for each new buffer of the top, the cell beside which it stands."""
    buffer = library.buffers[0]
    beside: dict[str, str] = {}
    fresh: dict[str, int] = {}
    delayed: dict[tuple[str, int], list[int]] = {}  # of a kind's net: the net behind so many buffers
    for (kind, cell, pin), number in buffers.items():
        module = modules(design)[kind] if kind else top(design)
        bits, index = _bits_of(module, cell, pin)
        if kind not in fresh:
            fresh[kind] = _next_net(module)
        behind = delayed.setdefault((kind, bits[index]), [bits[index]])
        while len(behind) <= number:
            output = fresh[kind]
            fresh[kind] += 1
            name = f"{HOLD_PREFIX}{output}"
            if not kind:
                beside[name] = cell
            module["cells"][name] = {
                "hide_name": 0, "type": buffer.name, "parameters": {}, "attributes": {},
                "port_directions": {buffer.input_pin: "input", buffer.output_pin: "output"},
                "connections": {buffer.input_pin: [behind[-1]], buffer.output_pin: [output]}}
            behind.append(output)
        bits[index] = behind[number]
    return beside


@dataclass(frozen=True)
class Dispensable:
    """A buffer of a block that could be removed: its driver could carry the load, if necessary as the cell `drive`."""

    kind: str  # of block
    buffer: str
    driver: str
    drive: str


def dispensable_buffers(design: dict, library: Library, kinds: Iterable[str],
                        pin_load: Callable[[str, str], float]) -> tuple[list[Dispensable], dict[str, dict[int, float]]]:
    """Buffers that the load limits of the cells do not require, and the loads of the blocks' nets without all of them. A drive that costs
    as much as the buffer is not considered. Not examined are buffers of trees, buffers that delay, and buffers behind a removable one."""
    found = []
    loads: dict[str, dict[int, float]] = {}
    buffers = {buffer.name: buffer for buffer in library.buffers}
    family = {kind: kinds for kinds in library.drives for kind in kinds}
    for kind in kinds:
        module = modules(design)[kind]
        cells = module["cells"]
        carried = {net: load_of(sinks) for net, sinks in sinks_of(module, pin_load, library.wire_ff_per_sink).items()}
        loads[kind] = carried
        ports = {bit for port in module["ports"].values() for bit in port["bits"]}
        drives = {bits[0]: (name, pin) for name, cell in cells.items() if cell["type"] in library.area
                  for pin, bits in cell["connections"].items() if cell["port_directions"].get(pin) == "output"}
        drive_of = {name: cell["type"] for name, cell in cells.items()}
        taken: set[str] = set()
        for name, cell in cells.items():
            buffer = buffers.get(cell["type"])
            if buffer is None or name.startswith((TREE_PREFIX, HOLD_PREFIX)):
                continue
            net, output = (cell["connections"][pin][0] for pin in (buffer.input_pin, buffer.output_pin))
            driver, pin = drives.get(net, ("", ""))
            if net in ports or output in ports or not driver or driver in taken:
                continue
            merged = carried[net] - buffer.input_ff - library.wire_ff_per_sink + carried.get(output, 0.0)
            now = drive_of[driver]
            stronger = family.get(now, [now])
            drive = next((other for other in stronger[stronger.index(now):]
                          if library.area[other] < library.area[now] + buffer.area
                          and merged <= library.max_load_ff[other][pin] * TREE_LOAD_SHARE), None)
            if drive is None:
                continue
            drive_of[driver] = drive
            carried[net] = merged
            taken.add(name)
            found.append(Dispensable(kind, name, driver, drive))
    return found, loads


def drop_buffers(design: dict, library: Library, dropped: Iterable[tuple[str, str]]) -> None:
    """Removes buffers (kind of block, cell): connects their loads to their drivers."""
    buffers = {buffer.name: buffer for buffer in library.buffers}
    replaced: dict[str, dict[int, int]] = {}
    for kind, name in dropped:
        cell = modules(design)[kind]["cells"].pop(name)
        buffer = buffers[cell["type"]]
        replaced.setdefault(kind, {})[cell["connections"][buffer.output_pin][0]] = cell["connections"][buffer.input_pin][0]
    for kind, nets in replaced.items():
        for cell in modules(design)[kind]["cells"].values():
            for bits in cell["connections"].values():
                for index, bit in enumerate(bits):
                    while bit in nets:  # behind several of them
                        bit = nets[bit]
                    bits[index] = bit


def resize(design: dict, library: Library, cells: Iterable[tuple[str, str, str]]) -> None:
    """Changes the drive of cells (kind of block or TOP, name, library cell). FlowError if the new cell has another function."""
    family = {kind: index for index, kinds in enumerate(library.drives) for kind in kinds}
    for kind, name, drive in cells:
        cell = (top(design) if kind == TOP else modules(design)[kind])["cells"][name]
        if drive not in family or family.get(cell["type"]) != family[drive]:
            raise FlowError(f"{name} is a {cell['type']} and cannot be resized to {drive}")
        cell["type"] = drive


def shrinkable(design: dict, library: Library, kinds: Iterable[str], pin_load: Callable[[str, str], float],
               carried: dict[str, dict[int, float]] | None = None) -> list[tuple[str, str]]:
    """(kind of block or TOP, cell) of cells whose load the next smaller drive can carry; those that save most come first. Buffers of
    fan-out trees and the registers in front of them keep their drive. `carried`: largest possible loads of a kind's nets, where they differ
    from the present ones."""
    found = []
    next_smaller = library.smaller
    for kind in kinds:
        module = top(design) if kind == TOP else modules(design)[kind]
        loads = (carried or {}).get(kind) or {net: load_of(sinks) for net, sinks in
                                              sinks_of(module, pin_load, library.wire_ff_per_sink).items()}
        for name, cell in module["cells"].items():
            smaller = next_smaller.get(cell["type"])
            if smaller is None or name.startswith(TREE_PREFIX) or COPY_SUFFIX in name:
                continue
            outputs = [(pin, bits[0]) for pin, bits in cell["connections"].items()
                       if cell["port_directions"].get(pin) == "output"]
            if all(loads.get(bit, 0.0) <= library.max_load_ff[smaller][pin] * TREE_LOAD_SHARE for pin, bit in outputs):
                found.append((library.area[cell["type"]] - library.area[smaller], kind, name))
    return [(kind, name) for _, kind, name in sorted(found, key=lambda item: -item[0])]


def clock_nets(module: Module) -> set[int]:
    """Clock nets of the module: its clock ports' nets and the nets behind clock gates."""
    return port_clock_nets(module) | {bit for name, cell in module["cells"].items() if name.startswith(CLOCK_GATE_PREFIX)
                                      for pin, bits in cell["connections"].items()
                                      if cell["port_directions"].get(pin) == "output" for bit in bits}


def constant_nets(module: Module, library: Library) -> set[int]:
    """Nets of tie cells; a layout puts a tie cell wherever a constant is needed."""
    ties = {cell for cell, _ in library.tie.values()}
    return {bit for cell in module["cells"].values() if cell["type"] in ties
            for bits in cell["connections"].values() for bit in bits}


def port_loads(module: Module, pin_load: Callable[[str, str], float], wire: float) -> dict[str, list[float]]:
    """Load behind each bit of each input port, fF."""
    nets = sinks_of(module, pin_load, wire)
    return {name: [sum(sink.load for sink in nets.get(bit, [])) if isinstance(bit, int) else 0.0
                   for bit in port["bits"]]
            for name, port in module["ports"].items() if port["direction"] == "input"}


def cell_kinds(design: dict, library: Library) -> set[str]:
    """Library cells that the design uses."""
    used = {cell["type"] for module in modules(design).values() for cell in module["cells"].values()}
    return used & set(library.area)


def prepare_simulation(design: dict, library: Library, suffix: str, power_up: str,
                       draw: Callable[[], bool]) -> None:
    """Appends a suffix to the names of the design's own modules, so that they can coexist with the RTL's. Sets every register's state at
    time 0 by its parameter `power_up`; instances of one module get equal states. Modules draw in the design's order, which is the same in
    each run of Python."""
    own = [name for name, module in modules(design).items() if module["cells"]]
    for name in own:
        module = modules(design).pop(name)
        modules(design)[name + suffix] = module
        for cell in module["cells"].values():
            if cell["type"] in own:
                cell["type"] += suffix
            elif cell["type"] in library.sequential:
                cell["parameters"] = {power_up: "1" if draw() else "0"}
