# SPDX-License-Identifier: Apache-2.0
"""Positions of cells on the die, and the buffers and repeaters that the wires between them need.

Columns stand side by side in order. The shared logic is below their middle, an engine below the middle of its pairs of columns, and the
ports of a column's timestamps above the column. Only the distance along the row counts: a column is 0.02 mm wide and the row 5 mm.

Between the shared logic and the columns a signal goes from register to register (hdl/common/dtof_broadcast.sv). The last register is
copied, so that each copy serves nearby columns through few buffers. Longer wires get a repeater every REPEATER_UM. If there are more than
two registers, those between the first and the last one are copied, too: each copy serves a stretch of the next registers, and the
registers of a way stand at equal distances. So do the registers on an engine's way back. All of this is in the netlist, so it is
counted, timed (spef.py) and simulated like any other cell.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import netlist
from .broadcast import Registers
from .configuration import Configuration
from .errors import FlowError
from .library import Library
from .netlist import TREE_LOAD_SHARE, Module, Sink, TreeBuilder

PITCH_UM = 25.0  # of the columns: that of the pixels above them
REPEATER_UM = 400.0  # a wire's own delay there is that of the repeater behind it
LEAF_UM = 200.0  # the columns that one buffer serves lie within it
LIGHT_FF = 4.0  # a pin that needs no buffer of its own
COPY_UM = 400.0  # the buffers that a copy of a register serves
TIMESTAMP_PORT = "tdc_timestamp_i"
# Ports whose way is shorter than an engine is wide, and has gates on it: the words of an engine's pairs are combined by OR from
# pair to pair on the way to it (docs/reference/poolpointer.md).
GATED_PORTS = {"line_i", "first_beside_i", "second_beside_i"}
# Registers that stand where their inputs come from: those of the segments of an engine's line (hdl/pool/dtof_pool_line.sv).
BESIDE_COLUMNS = re.compile(r"\bu_line\.words_q\b")
UNTIMED_PORTS = {"clk_i", "rst_ni", "sram_cfg_i"}


@dataclass(frozen=True)
class Wire:
    """A metal layer: resistance and capacitance, with neighbours on both sides."""

    ohm_per_um: float
    ff_per_um: float


# Resistance: metal 4 to 6 of FreePDK45's technology LEF (0.21 ohm per square, 0.14 um wide). Capacitance: the roadmap's 2 pF
# per cm of intermediate wires (ITRS 2007, Interconnect). Pessimistic: a quarter more of each.
TYPICAL = Wire(1.5, 0.20)
PESSIMISTIC = Wire(1.875, 0.25)


def _place_numbers(name: str) -> tuple[int, ...]:
    return tuple(int(number) for number in re.findall(r"\[(\d+)\]", name))


class Floorplan:
    """Positions of a mapped array's cells along the row, um."""

    def __init__(self, design: dict, columns_per_module: int, columns_per_engine: int = 0, pitch_um: float = PITCH_UM) -> None:
        self.array = netlist.top(design)
        column, engine = netlist.column_module(design), netlist.engine_module(design)
        self.blocks = {name for name, cell in self.array["cells"].items() if cell["type"] in (column, engine)}
        columns = sorted((name for name in self.blocks if self.array["cells"][name]["type"] == column), key=_place_numbers)
        self.module_um = pitch_um * columns_per_module
        self.width_um = self.module_um * len(columns)
        self.centre_um = self.width_um / 2
        self.places = {name: (index + 0.5) * self.module_um for index, name in enumerate(columns)}
        for name in self.blocks - set(columns):
            begin = _place_numbers(name)[0] * columns_per_engine * pitch_um
            self.places[name] = (begin + min(begin + columns_per_engine * pitch_um, self.width_um)) / 2
        self.timestamps = set(self.array["ports"].get(TIMESTAMP_PORT, {"bits": []})["bits"])
        self._place_gates()

    def rename(self, called: dict[str, str]) -> None:
        """Renames cells. `called`: the previous name of each."""
        self.places = {name: self.places[before] for name, before in called.items() if before in self.places}

    def __getitem__(self, cell: str) -> float:
        return self.places.get(cell, self.centre_um)

    def port_um(self, net: int, sink: str) -> float:
        """Position of an input port: above its column, or beside the shared logic."""
        return self[sink] if net in self.timestamps else self.centre_um

    def _place_gates(self) -> None:
        """Places gates whose inputs all come from columns in the middle of these columns, and also the registers BESIDE_COLUMNS (the OR of
        an engine's pairs)."""
        driver: dict[int, str] = {}
        for name, cell in self.array["cells"].items():
            for pin, bits in cell["connections"].items():
                if cell["port_directions"].get(pin) == "output":
                    driver.update((bit, name) for bit in bits if isinstance(bit, int))
        beside = {bit for name, net in self.array["netnames"].items() if BESIDE_COLUMNS.search(name) for bit in net["bits"]}
        known: dict[str, float | None] = {name: self.places[name] for name in self.blocks}

        def place(name: str) -> float | None:
            if name not in known:
                known[name] = None  # a loop through registers ends here
                cell = self.array["cells"][name]
                registered = "CK" in cell["connections"]
                if name not in self.places and (not registered or beside.intersection(cell["connections"].get("Q", []))):
                    inputs = [bit for pin, bits in cell["connections"].items() if pin == "D" or not registered
                              if cell["port_directions"].get(pin) == "input" for bit in bits if isinstance(bit, int)]
                    places = [place(driver[bit]) if bit in driver else None for bit in inputs]
                    if places and all(where is not None for where in places):
                        known[name] = sum(where for where in places if where is not None) / len(places)
            return known[name]

        for name in self.array["cells"]:
            where = place(name)
            if where is not None and name not in self.blocks:
                self.places[name] = where
        self._place_clock_gates()

    def _place_clock_gates(self) -> None:
        """Places each clock gate of the top in the middle of its registers."""
        gates = {bit: name for name, cell in self.array["cells"].items() if name.startswith(netlist.CLOCK_GATE_PREFIX)
                 for pin, bits in cell["connections"].items() if cell["port_directions"].get(pin) == "output" for bit in bits}
        behind: dict[str, list[float]] = {}
        for name, cell in self.array["cells"].items():
            for pin, bits in cell["connections"].items():
                if cell["port_directions"].get(pin) == "input":
                    for bit in bits:
                        if bit in gates:
                            behind.setdefault(gates[bit], []).append(self[name])
        self.places |= {gate: sum(places) / len(places) for gate, places in behind.items()}


class _Spreader:
    """Routes the top's nets to the positions of their sinks."""

    def __init__(self, plan: Floorplan, builder: TreeBuilder, library: Library, wire: Wire) -> None:
        self.plan = plan
        self.builder = builder
        self.wire = wire
        self.leaf_ff = library.buffers[-1].max_load_ff * TREE_LOAD_SHARE

    def _clusters(self, sinks: Iterable[Sink], limit_ff: float, span_um: float) -> list[list[Sink]]:
        """Groups of neighbouring sinks within a span and a load."""
        found: list[list[Sink]] = []
        for sink in sorted(sinks, key=lambda sink: self.plan[sink.cell]):
            last = found[-1] if found else []
            if (not last or self.plan[sink.cell] - self.plan[last[0].cell] > span_um
                    or netlist.load_of(last) + sink.load > limit_ff or len(last) == netlist.MAX_FANOUT):
                found.append([sink])
            else:
                last.append(sink)
        return found

    def _centre(self, cluster: list[Sink]) -> float:
        return (self.plan[cluster[0].cell] + self.plan[cluster[-1].cell]) / 2

    def _span_ff(self, cluster: list[Sink], start_um: float) -> float:
        places = [start_um, *(self.plan[sink.cell] for sink in cluster)]
        return (max(places) - min(places)) * self.wire.ff_per_um

    def _buffer(self, net: int, cluster: list[Sink], place_um: float) -> Sink:
        sink = self.builder.buffer(net, cluster, self._span_ff(cluster, place_um))
        self.plan.places[sink.cell] = place_um
        return sink

    def spread(self, net: int, driver: str | None, maximum_ff: float, copy: bool, number: int = 0, span_um: float = COPY_UM) -> None:
        """Gives a net the buffers and repeaters that it needs. `copy`: the net's driver is a register that may be copied. `number`: of a
        register between the first and the last one of its way (broadcast.py); a copy of it serves `span_um` of the next registers."""
        sinks = self.builder.nets[net]
        start = self.plan[driver] if driver is not None else self.plan.port_um(net, sinks[0].cell)
        limit = maximum_ff * TREE_LOAD_SHARE
        if len(sinks) <= netlist.MAX_FANOUT and netlist.load_of(sinks) + self._span_ff(sinks, start) <= limit and all(
                abs(self.plan[sink.cell] - start) <= REPEATER_UM for sink in sinks):
            return
        near = [sink for sink in sinks if abs(self.plan[sink.cell] - start) <= self.plan.module_um]
        if netlist.load_of(near) > limit / 2 or len(near) > netlist.MAX_FANOUT / 2:
            near = []
        far = [sink for sink in sinks if all(sink is not other for other in near)]
        leaves = [self._buffer(net, cluster, self._centre(cluster))
                  if len(cluster) > 1 or cluster[0].load > LIGHT_FF else cluster[0]
                  for cluster in self._clusters(far, self.leaf_ff - LEAF_UM * self.wire.ff_per_um, LEAF_UM)]
        if copy and driver is not None:
            for cluster in self._clusters(leaves, self.leaf_ff - COPY_UM * self.wire.ff_per_um, COPY_UM):
                name, copied = self.builder.copy_register(net, cluster)
                self.plan.places[name] = self._centre(cluster)
                self.builder.nets[copied] = self._relieve(copied, self.plan[name], cluster, limit)
            self.builder.nets[net] = near
        elif number and driver is not None:
            for cluster in self._clusters(leaves, math.inf, span_um):
                farthest = max((self.plan[sink.cell] for sink in cluster), key=lambda place: abs(place - start))
                name, copied = self.builder.copy_register(net, cluster)
                self.plan.places[name] = place = start + (farthest - start) * (number - 1) / number
                self.builder.nets[copied] = self._relieve(copied, place, self._trunk(copied, place, cluster), limit)
            self.builder.nets[net] = near
        else:
            self.builder.nets[net] = self._relieve(net, start, near + self._trunk(net, start, leaves), limit)

    def _trunk(self, net: int, start: float, sinks: list[Sink]) -> list[Sink]:
        """Sinks that the driver of a wire to both sides drives itself; the others are behind repeaters."""
        first: list[Sink] = []
        for side in (-1, 1):
            hops: dict[int, list[Sink]] = {}
            for sink in sinks:
                way = (self.plan[sink.cell] - start) * side
                if way > 0 or (way == 0 and side == 1):
                    hops.setdefault(int(way // REPEATER_UM), []).append(sink)
            for hop in range(max(hops, default=0), 0, -1):
                repeater = self._buffer(net, hops.get(hop, []), start + side * hop * REPEATER_UM)
                hops.setdefault(hop - 1, []).append(repeater)
            first += hops.get(0, [])
        return first

    def _relieve(self, net: int, start: float, sinks: list[Sink], limit: float) -> list[Sink]:
        """Adds buffers beside a driver that is too weak."""
        while netlist.load_of(sinks) + self._span_ff(sinks, start) > limit or len(sinks) > netlist.MAX_FANOUT:
            room = self.leaf_ff - REPEATER_UM * self.wire.ff_per_um
            parents = [self._buffer(net, cluster, start) for cluster in self._clusters(sinks, room, 2 * REPEATER_UM)]
            if len(parents) == 1 or len(parents) == len(sinks):
                return parents
            sinks = parents
        return sinks


def spread(plan: Floorplan, library: Library, pin_load: Callable[[str, str], float], skip: set[int],
           wire: Wire = PESSIMISTIC, stages: int = 2) -> None:
    """Inserts trees, copies of registers and repeaters in the top. `skip`: clocks and constants; `stages`: registers from the shared logic
    to a block."""
    array = plan.array
    builder = TreeBuilder(array, library, pin_load)
    spreader = _Spreader(plan, builder, library, wire)
    drivers = dict(netlist.drivers_of(array, library, library.buffers[0].max_load_ff))
    cell_of = {bit: name for name, cell in array["cells"].items() for pin, bits in cell["connections"].items()
               if cell["port_directions"].get(pin) == "output" for bit in bits if isinstance(bit, int)}
    registers = {net for net, name in builder.drivers.items() if array["cells"][name]["type"] in library.sequential}
    # The last registers of a broadcast first: copies add sinks to the nets before them.
    copied = {net for net in registers if any(sink.cell in plan.blocks for sink in builder.nets.get(net, []))}
    numbers: dict[int, int] = {}
    if stages > 2:
        rows = Registers(array, set(library.sequential), netlist.clock_nets(array) - netlist.port_clock_nets(array))
        numbers = rows.numbers(copied, stages)
        outputs = {net: plan[name] for net, name in cell_of.items() if name in plan.blocks}
        # A register that drives an output port of the array stays beside the shared logic, where the ports are.
        at_ports = {cell_of[net] for port in array["ports"].values() if port["direction"] == "output" for net in port["bits"] if net in cell_of}
        plan.places |= rows.results(outputs, plan.places.keys() | at_ports, plan.centre_um, stages)
    moved = copied | numbers.keys()
    order: list[int] = []

    def put(net: int) -> None:
        for sink in builder.nets.get(net, []):
            behind = [bit for bits in array["cells"][sink.cell]["connections"].values() for bit in bits if bit in moved]
            if array["cells"][sink.cell]["type"] in library.sequential:
                for other in behind:
                    if other != net and other not in order and cell_of[other] == sink.cell:
                        put(other)
        if net not in order:
            order.append(net)

    for net in sorted(moved):
        put(net)
    for net in [*order, *sorted(drivers.keys() - moved)]:
        if net not in skip and builder.nets.get(net):
            spreader.spread(net, cell_of.get(net), drivers[net], net in copied, numbers.get(net, 0), plan.centre_um / max(stages - 1, 1))


def pin_load(library: Library, macro_pin_ff: float) -> Callable[[str, str], float]:
    """Function that returns the load of a pin of a library cell or a macro."""
    return lambda kind, pin: library.input_ff[kind].get(pin, 0.0) if kind in library.input_ff else macro_pin_ff


def finish(design: dict, library: Library, macro_pin_ff: float, configuration: Configuration
           ) -> Floorplan:
    """Inserts the trees of column, engine and top; returns the places."""
    wire = library.wire_ff_per_sink
    name = netlist.column_module(design)
    mean: dict[str, dict[str, float]] = {}
    cell_load = pin_load(library, macro_pin_ff)

    for part in filter(None, (netlist.engine_module(design), name)):
        module = netlist.modules(design)[part]
        netlist.insert_fanout_trees(module, library, cell_load, netlist.clock_nets(module))
        loads = netlist.port_loads(module, cell_load, wire)
        mean[part] = {port: max(values, default=0.0) for port, values in loads.items()}

    def top_load(kind: str, pin: str) -> float:
        return mean[kind].get(pin, 0.0) if kind in mean else cell_load(kind, pin)

    array = netlist.top(design)
    plan = Floorplan(design, configuration.module_columns, configuration.engine_columns)
    spread(plan, library, top_load, netlist.clock_nets(array) | netlist.constant_nets(array, library),
           stages=configuration["BROADCAST_STAGES"])
    return plan


def check_borders(design: dict, library: Library) -> None:
    """FlowError if an input of a column or an engine does not come from a register through buffers alone. A timestamp's port counts as a
    register, that of its TDC."""
    array = netlist.top(design)
    timestamps = set(array["ports"].get(TIMESTAMP_PORT, {"bits": []})["bits"])
    blocks = {netlist.column_module(design), netlist.engine_module(design)}
    through = {buffer.name for buffer in library.buffers} | {kind for kind in library.area if kind.startswith("INV")}
    constant = {cell for cells in library.tie.values() for cell in cells[:1]}
    registered = {part: _registered_ports(netlist.modules(design)[part], library.sequential | constant, through)
                  for part in blocks if part}
    driver: dict[int, tuple[Module, str]] = {}
    for cell in array["cells"].values():
        for pin, bits in cell["connections"].items():
            if cell["port_directions"].get(pin) == "output":
                driver.update((bit, (cell, pin)) for bit in bits if isinstance(bit, int))
    for name, cell in array["cells"].items():
        if cell["type"] not in blocks:
            continue
        for port, bits in cell["connections"].items():
            if cell["port_directions"].get(port) != "input" or port in UNTIMED_PORTS | GATED_PORTS:
                continue
            for index, bit in enumerate(bits):
                while bit in driver and driver[bit][0]["type"] in through:
                    source = driver[bit][0]
                    bit = next(net[0] for pin, net in source["connections"].items()
                               if source["port_directions"][pin] == "input")
                if not isinstance(bit, int) or bit in timestamps:
                    continue
                kind, pin = (driver[bit][0]["type"], driver[bit][1]) if bit in driver else ("a port of the array", "")
                if kind not in library.sequential | constant and pin not in registered.get(kind, set()):
                    raise FlowError(f"{name}.{port}[{index}] does not come from a register but from {kind}")


def _registered_ports(module: Module, sources: set[str], through: set[str]) -> set[str]:
    """Outputs of a module whose bits all come from `sources`, registers or constants, through buffers alone."""
    driver = {bits[0]: cell for cell in module["cells"].values() for pin, bits in cell["connections"].items()
              if cell["port_directions"].get(pin) == "output" and len(bits) == 1}
    found = set()
    for port, description in module["ports"].items():
        if description["direction"] != "output":
            continue
        for bit in description["bits"]:
            while bit in driver and driver[bit]["type"] in through:
                bit = next(net[0] for pin, net in driver[bit]["connections"].items()
                           if driver[bit]["port_directions"][pin] == "input")
            if isinstance(bit, int) and (bit not in driver or driver[bit]["type"] not in sources):
                break
        else:
            found.add(port)
    return found
