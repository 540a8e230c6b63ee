# SPDX-License-Identifier: Apache-2.0
"""What every driver has to carry against its limits: the Liberty's max_capacitance, and a number of inputs.

OpenSTA of 2019 checks neither. Inside a block a net has its pins and the wire load of each; a net between blocks has the wire of the
floorplan besides, in the slow corner. Not looked at: the clock, which has a tree of its own; constants, of which a layout puts a tie
wherever one is needed; what input ports drive; and the SRAMs' side band, which rests (endpoints.py).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import endpoints, netlist, spef
from .errors import FlowError
from .floorplan import PESSIMISTIC, Floorplan
from .library import Library

MAX_FANOUT = 200  # inputs of a net; the reset's tree has up to 174 of 1 fF each behind its strongest buffers
_MOST_NAMED = 3


@dataclass(frozen=True)
class Load:
    """Of one driver: fF with its limit, and inputs."""

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
    """The nets that do not leave a column or an engine."""
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


def of_top(design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> Iterable[Load]:
    """The nets between blocks, from the cell that drives them to the last input in a block."""
    array = netlist.top(design)
    skip = netlist.clock_nets(array) | netlist.constant_nets(array, library)
    for bit, pins in spef.Nets(design, plan, library).pins().items():
        drivers = [pin for pin in pins if pin.is_output and "/" in pin.name]
        if bit in skip or len(drivers) != 1 or any(endpoints.SIDE_BAND.fullmatch(pin.name) for pin in pins):
            continue
        cell, output = _cell(design, drivers[0].name)
        limit = library.max_load_ff.get(cell["type"], {}).get(output, 0.0)
        sinks = [pin for pin in pins if not pin.is_output]
        ff = (max(pin.place_um for pin in pins) - min(pin.place_um for pin in pins)) * PESSIMISTIC.ff_per_um
        for pin in sinks:
            if "/" in pin.name:
                sink, name = _cell(design, pin.name)
                ff += pin_load(sink["type"], name) + pin.wire_ff
        if limit:
            yield Load(drivers[0].name, ff, limit, len(sinks))


def _cell(design: dict, name: str) -> tuple[dict, str]:
    """The cell of a pin named as OpenSTA does, and the pin's name without its bit."""
    kind, cell, pin = netlist.local_pin(design, name)
    return (netlist.modules(design)[kind] if kind else netlist.top(design))["cells"][cell], pin.split("[")[0]


def check(name: str, design: dict, plan: Floorplan, library: Library, pin_load: Callable[[str, str], float]) -> Load:
    """The load that is nearest to its limit; FlowError if one is beyond. `design`: with all columns real."""
    blocks = [kind for kind in (netlist.column_module(design), netlist.engine_module(design)) if kind]
    found = [load for kind in blocks for load in of_block(design, kind, library, pin_load)]
    found += of_top(design, plan, library, pin_load)
    too_much = [load for load in found if load.is_too_much]
    if too_much:
        raise FlowError(f"{name}: {len(too_much)} drivers have too much to drive: {'; '.join(map(str, too_much[:_MOST_NAMED]))}")
    return max(found, key=lambda load: load.ff / load.limit_ff)
