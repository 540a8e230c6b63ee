# SPDX-License-Identifier: Apache-2.0
"""Wires between the blocks of an array as SPEF, from the floorplan, for OpenSTA.

A wire runs from its driver along the row to its farthest sinks, with a piece of `Wire` between any two neighbours. Wires inside a block
have the library's wire load, which is put at the pins here, since OpenSTA applies no wire load to a net with a description of its own.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from . import netlist
from .floorplan import Floorplan, Wire
from .library import Library
from .netlist import Module

LOCAL_UM = 20.0  # nets whose cells are closer to each other than this are left to the wire load
_HEADER = """*SPEF "IEEE 1481-1998"
*DESIGN "{design}"
*DATE "-"
*VENDOR "dtof-readout"
*PROGRAM "make synth"
*VERSION "1"
*DESIGN_FLOW "FLOORPLAN"
*DIVIDER /
*DELIMITER :
*BUS_DELIMITER [ ]
*T_UNIT 1 NS
*C_UNIT 1 FF
*R_UNIT 1 OHM
*L_UNIT 1 HENRY
"""


def plain_names(design: dict) -> dict[str, dict[str, str]]:
    """Gives every cell a name of letters, digits and underscores, which needs no escape in Verilog, SPEF or a report. Returns the previous
    names by module."""
    called: dict[str, dict[str, str]] = {}
    for kind, module in netlist.modules(design).items():
        before = called.setdefault(kind, {})
        renamed: dict[str, dict] = {}
        for name, cell in module["cells"].items():
            plain = re.sub(r"\W", "_", name)
            while plain in renamed:
                plain += "_"
            renamed[plain] = cell
            before[plain] = name
        module["cells"] = renamed
    return called


@dataclass(frozen=True)
class _Pin:
    name: str  # in OpenSTA's hierarchy
    is_output: bool
    place_um: float
    wire_ff: float  # of the wires inside its block


class Nets:
    """Pins of the top's nets, including those inside columns and engines."""

    def __init__(self, design: dict, plan: Floorplan, library: Library) -> None:
        self.design = design
        self.plan = plan
        self.library = library
        self.inside: dict[str, dict[int, list[tuple[str, bool]]]] = {}

    def _inside(self, kind: str) -> dict[int, list[tuple[str, bool]]]:
        """(cell/pin, whether it is an output) for every net of a module."""
        if kind not in self.inside:
            nets: dict[int, list[tuple[str, bool]]] = {}
            for name, cell in netlist.modules(self.design)[kind]["cells"].items():
                for pin, bits in cell["connections"].items():
                    is_output = cell["port_directions"].get(pin) == "output"
                    for index, bit in enumerate(bits):
                        if isinstance(bit, int):
                            nets.setdefault(bit, []).append((f"{name}/{_bit(pin, index, bits)}", is_output))
            self.inside[kind] = nets
        return self.inside[kind]

    def pins(self) -> dict[int, list[_Pin]]:
        array = netlist.top(self.design)
        wire = self.library.wire_ff_per_sink
        found: dict[int, list[_Pin]] = {}
        for name, cell in array["cells"].items():
            module = netlist.modules(self.design).get(cell["type"])
            for pin, bits in cell["connections"].items():
                is_output = cell["port_directions"].get(pin) == "output"
                for index, bit in enumerate(bits):
                    if not isinstance(bit, int):
                        continue
                    own = found.setdefault(bit, [])
                    if module and module["cells"]:
                        inner = module["ports"][pin]["bits"][index]
                        own += [_Pin(f"{name}/{leaf}", output, self.plan[name], 0.0 if output else wire)
                                for leaf, output in self._inside(cell["type"]).get(inner, []) if output == is_output]
                    else:
                        offset = module["ports"][pin].get("offset", 0) if module else 0
                        own.append(_Pin(f"{name}/{_bit(pin, index + offset, bits)}", is_output, self.plan[name],
                                        0.0 if is_output or module else wire))
        for name, port in array["ports"].items():
            for index, bit in enumerate(port["bits"]):
                if isinstance(bit, int) and found.get(bit):
                    place = self.plan.port_um(bit, "") if bit not in self.plan.timestamps else found[bit][0].place_um
                    found[bit].append(_Pin(_bit(name, index, port["bits"]), port["direction"] == "input", place, 0.0))
        return found


def _bit(pin: str, index: int, bits: list) -> str:
    return pin if len(bits) == 1 else f"{pin}[{index}]"


def _wire(net: str, rows: list[_Pin], wire: Wire) -> list[str]:
    """One *D_NET: a row of nodes and their pins, from left to right."""
    pieces = [(left, right, right.place_um - left.place_um) for left, right in zip(rows, rows[1:])]
    caps = {pin.name: pin.wire_ff for pin in rows}
    for left, right, length in pieces:
        caps[left.name] += length * wire.ff_per_um / 2
        caps[right.name] += length * wire.ff_per_um / 2
    lines = [f"*D_NET {net} {sum(caps.values()):.4f}", "*CONN"]
    for pin in rows:
        kind = "*I" if "/" in pin.name else "*P"
        node = pin.name if kind == "*P" else ":".join(pin.name.rsplit("/", 1))
        # A port is an output of the array where it is a sink of the net.
        direction = ("O" if pin.is_output else "I") if kind == "*I" else ("I" if pin.is_output else "O")
        lines.append(f"{kind} {node} {direction}")
    lines.append("*CAP")
    lines += [f"{index} {_node(pin)} {caps[pin.name]:.4f}" for index, pin in enumerate(rows, 1)]
    lines.append("*RES")
    lines += [f"{index} {_node(left)} {_node(right)} {max(length * wire.ohm_per_um, 0.01):.4f}"
              for index, (left, right, length) in enumerate(pieces, 1)]
    return [*lines, "*END", ""]


def _node(pin: _Pin) -> str:
    return ":".join(pin.name.rsplit("/", 1)) if "/" in pin.name else pin.name


def write(design: dict, plan: Floorplan, library: Library, wires: Iterable[Wire], skip: set[int]) -> list[str]:
    """SPEF of the design, with real columns or stand-ins, for each kind of wire. Gives each net that it describes a unique name. `skip`:
    clock nets."""
    array: Module = netlist.top(design)
    ports = {bit: (name, index, port["bits"]) for name, port in array["ports"].items()
             for index, bit in enumerate(port["bits"])}
    ties = netlist.constant_nets(array, library)
    header = _HEADER.format(design=next(name for name, module in netlist.modules(design).items() if module is array))
    described: list[tuple[str, list[_Pin]]] = []
    named: dict[str, dict] = {}
    for bit, pins in sorted(Nets(design, plan, library).pins().items()):
        places = [pin.place_um for pin in pins]
        drivers = sum(pin.is_output for pin in pins)
        if bit in skip or bit in ties or drivers != 1 or len(pins) < 2 or max(places) - min(places) < LOCAL_UM:
            continue
        net = _bit(*ports[bit]) if bit in ports else f"wire_{bit}"
        if bit not in ports:
            named[net] = {"hide_name": 0, "bits": [bit], "attributes": {}}
        described.append((net, sorted(pins, key=lambda pin: (pin.place_um, pin.name))))
    array["netnames"] = {name: net for name, net in array["netnames"].items() if name in array["ports"]} | named
    return ["\n".join([header, *(line for net, rows in described for line in _wire(net, rows, wire))]) for wire in wires]
