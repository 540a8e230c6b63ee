# SPDX-License-Identifier: Apache-2.0
"""Loads of all drivers compared with their limits: the Liberty's max_capacitance, and a number of inputs.

OpenSTA of 2019 checks neither. Inside a block a net has its pins and the wire load of each. A net between blocks also has the wire of the
floorplan, in the slow corner. Not examined are the clock, which has a tree of its own; constants, since a layout puts a tie cell wherever
one is needed; and the nets that input ports drive.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import netlist, spef
from .errors import FlowError
from .floorplan import PESSIMISTIC, Floorplan
from .library import Library
from .netlist import MAX_FANOUT

_MOST_NAMED = 3


@dataclass(frozen=True)
class Load:
    """Load of one driver in fF with its limit, and the number of inputs."""

    driver: str
    ff: float
    limit_ff: float
    inputs: int

    @property
    def is_too_much(self) -> bool:
        return self.ff > self.limit_ff or self.inputs > MAX_FANOUT

    def __str__(self) -> str:
        return f"{self.driver} drives {self.ff:.1f} fF of {self.limit_ff:.1f} and {self.inputs} inputs of {MAX_FANOUT}"


def of_block(design: dict, kind: str, library: Library, pin_load: Callable[[str, str], float]) -> Iterable[Load]:
    """Loads of the nets inside a column or an engine."""
    module = netlist.modules(design)[kind]
    ports = {bit for port in module["ports"].values() for bit in port["bits"]}
    skip = ports | netlist.clock_nets(module) | netlist.constant_nets(module, library)
    sinks = netlist.sinks_of(module, pin_load, library.wire_ff_per_sink)
    for name, cell in module["cells"].items():
        for pin, bits in cell["connections"].items():
            limit = library.max_load_ff.get(cell["type"], {}).get(pin, 0.0)
            if cell["port_directions"].get(pin) == "output" and limit and bits[0] not in skip:
                found = sinks.get(bits[0], [])
                yield Load(f"{kind}/{name}", netlist.load_of(found), limit, len(found))


@dataclass(frozen=True)
class _Driven:
    """A net between blocks: its driver (a cell of a block or of the top) and its load."""

    name: str
    block: str  # kind of block, or netlist.TOP
    cell: str
    pin: str
    bit: int  # in the block
    ff: float
    inputs: int


def _driven(design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> Iterable[_Driven]:
    """All nets between blocks, from the driving cell to the last input in a block."""
    array = netlist.top(design)
    skip = netlist.clock_nets(array) | netlist.constant_nets(array, library)
    inside: dict[str, dict[int, list[netlist.Sink]]] = {}
    for bit, pins in spef.Nets(design, plan, library).pins().items():
        drivers = [pin for pin in pins if pin.is_output and "/" in pin.name]
        if bit in skip or len(drivers) != 1:
            continue
        kind, cell, pin = netlist.local_pin(design, drivers[0].name)
        module = netlist.modules(design)[kind] if kind else array
        ff = (max(one.place_um for one in pins) - min(one.place_um for one in pins)) * PESSIMISTIC.ff_per_um
        inputs = 0
        for one in pins:
            if not one.is_output:
                inputs += 1
                if "/" in one.name:
                    ff += pin_load(*_kind_and_pin(design, one.name)) + one.wire_ff
        own = module["cells"][cell]["connections"][pin.split("[")[0]][0]
        if kind:  # what hangs on it in its own block
            if kind not in inside:
                inside[kind] = netlist.sinks_of(module, pin_load, library.wire_ff_per_sink)
            sinks = inside[kind].get(own, [])
            ff += netlist.load_of(sinks)
            inputs += len(sinks)
        yield _Driven(drivers[0].name, kind or netlist.TOP, cell, pin.split("[")[0], own, ff, inputs)


def of_top(design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> Iterable[Load]:
    """Loads of the nets between blocks."""
    for one in _driven(design, plan, library, pin_load):
        module = netlist.top(design) if one.block == netlist.TOP else netlist.modules(design)[one.block]
        limit = library.max_load_ff.get(module["cells"][one.cell]["type"], {}).get(one.pin, 0.0)
        if limit:
            yield Load(one.name, one.ff, limit, one.inputs)


def between_blocks(design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> dict[str, dict[int, float]]:
    """Load in fF of the nets between blocks, by the kind of block that drives them and its net; the largest over the instances."""
    found: dict[str, dict[int, float]] = {}
    for one in _driven(design, plan, library, pin_load):
        nets = found.setdefault(one.block, {})
        nets[one.bit] = max(one.ff, nets.get(one.bit, 0.0))
    return found


def strengthen(design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> None:
    """Replaces each cell of the top that is too weak for its wire by one with enough drive, if there is one."""
    family = {kind: kinds for kinds in library.drives for kind in kinds}
    cells = netlist.top(design)["cells"]
    for one in _driven(design, plan, library, pin_load):
        if one.block == netlist.TOP and cells[one.cell]["type"] in family:
            kinds = family[cells[one.cell]["type"]]
            stronger = kinds[kinds.index(cells[one.cell]["type"]):]
            cells[one.cell]["type"] = next((kind for kind in stronger if one.ff <= library.max_load_ff[kind][one.pin]
                                            * netlist.TREE_LOAD_SHARE), stronger[-1])


def _kind_and_pin(design: dict, name: str) -> tuple[str, str]:
    """Cell type and pin name (without bit) of a pin named as in OpenSTA."""
    kind, cell, pin = netlist.local_pin(design, name)
    return (netlist.modules(design)[kind] if kind else netlist.top(design))["cells"][cell]["type"], pin.split("[")[0]


def of_all(design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> list[Load]:
    """Loads of all drivers. `design`: with all columns real."""
    blocks = [kind for kind in (netlist.column_module(design), netlist.engine_module(design)) if kind]
    found = [load for kind in blocks for load in of_block(design, kind, library, pin_load)]
    return found + [*of_top(design, plan, library, pin_load)]


def check(name: str, design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> Load:
    """The load that is closest to its limit. FlowError if one exceeds its limit. `design`: with all columns real."""
    found = of_all(design, plan, library, pin_load)
    too_much = [load for load in found if load.is_too_much]
    if too_much:
        raise FlowError(f"{name}: {len(too_much)} drivers have too much to drive: {'; '.join(map(str, too_much[:_MOST_NAMED]))}")
    return max(found, key=lambda load: load.ff / load.limit_ff)
