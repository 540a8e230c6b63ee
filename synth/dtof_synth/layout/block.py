# SPDX-License-Identifier: Apache-2.0
"""The column of a mapped design as a flat block with scalar nets, in the formats that the layout tools read.

The SRAM is left out: its pins become pins on the block's edge. qflow numbers the cells of a kind in the order of the
BLIF file, so the instances have these names from the beginning, and `origin` says what a cell was called before.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field

from ..errors import FlowError
from ..library import Library

SRAM_PORTS = {"read_data_i", "write_data_o"}  # of a block whose SRAM stands outside
CONSTANTS = {"0": "gnd", "1": "vdd", "x": "gnd", "z": "gnd"}
SUPPLIES = ("vdd", "gnd")
CLOCK = "clk_i"


@dataclass(frozen=True)
class Cell:
    """A library cell. `pins`: net of each pin."""

    name: str
    kind: str
    pins: dict[str, str]
    origin: str


@dataclass
class Block:
    """A flat block. `ports`: direction by net. A net has at most one port, and every port connects to a cell's pin."""

    name: str
    cells: list[Cell]
    ports: dict[str, str]
    sram_ports: list[str] = field(default_factory=list)

    @property
    def inputs(self) -> list[str]:
        return [net for net, direction in self.ports.items() if direction == "input"]

    @property
    def outputs(self) -> list[str]:
        return [net for net, direction in self.ports.items() if direction == "output"]

    def sinks(self, library: Library) -> Counter[str]:
        """For every net, the number of cell pins and edge pins that it drives."""
        return Counter([*(net for cell in self.cells for pin, net in cell.pins.items()
                          if pin in library.input_ff[cell.kind]), *self.outputs])

    def area(self, library: Library) -> float:
        return sum(library.area[cell.kind] for cell in self.cells)


def _bits(name: str, bits: list) -> list[tuple[str, int | str]]:
    return [(name if len(bits) == 1 else f"{name}_{index}", bit) for index, bit in enumerate(bits)]


def from_module(name: str, module: dict, library: Library, macros: set[str]) -> Block:
    """Block of a mapped module in Yosys's JSON. `macros`: cell types of the SRAMs."""
    rams = {cell: item for cell, item in sorted(module["cells"].items()) if item["type"] in macros}
    cells = {cell: item for cell, item in sorted(module["cells"].items()) if item["type"] not in macros}
    foreign = {item["type"] for item in cells.values()} - set(library.area)
    if foreign:
        raise FlowError(f"{name}: cells that the library does not have: {', '.join(sorted(foreign))}")

    pins = [(item["port_directions"][pin] == "output", bit) for item in cells.values()
            for pin, bits in item["connections"].items() for bit in bits if isinstance(bit, int)]
    driven = {bit for is_output, bit in pins if is_output}
    used = {bit for _, bit in pins}
    names: dict[int, str] = {}
    ports: dict[str, str] = {}
    sram_ports: list[str] = []

    def add(port: str, bit: int | str, own: list[str] | None = None) -> None:
        """Adds a port if its net connects to a cell and has no other port."""
        if isinstance(bit, int) and bit in used and bit not in names:
            names[bit] = port
            ports[port] = "output" if bit in driven else "input"
            if own is not None:
                own.append(port)

    for port, description in module["ports"].items():
        for bit_name, bit in _bits(port, description["bits"]):
            add(bit_name, bit, sram_ports if port in SRAM_PORTS else None)
    for number, item in enumerate(rams.values()):
        for pin, bits in item["connections"].items():
            for bit_name, bit in _bits(f"sram{number if len(rams) > 1 else ''}_{pin}", bits):
                add(bit_name, bit, sram_ports)

    def net(bit: int | str) -> str:
        return names.setdefault(bit, f"n{bit}") if isinstance(bit, int) else CONSTANTS[bit]

    numbers: Counter[str] = Counter()
    found = []
    for origin, item in cells.items():
        kind = item["type"]
        numbers[kind] += 1
        connected = {pin: net(bits[0]) for pin, bits in item["connections"].items() if bits}
        missing = [pin for pin in library.max_load_ff[kind] if pin not in connected]
        open_nets = {pin: f"open_{kind}_{numbers[kind]}_{pin}" for pin in missing}
        found.append(Cell(f"{kind}_{numbers[kind]}", kind, connected | open_nets, origin))
    return Block(name, found, ports, sram_ports)


def blif(block: Block) -> str:
    lines = [f".model {block.name}", f".inputs {' '.join(block.inputs)}", f".outputs {' '.join(block.outputs)}"]
    lines += [f".gate {cell.kind} {' '.join(f'{pin}={net}' for pin, net in cell.pins.items())}"
              for cell in block.cells]
    return "\n".join([*lines, ".end", ""])


def verilog(block: Block) -> str:
    """Verilog for OpenSTA: constants as literals, no supplies."""
    literal = {"vdd": "1'b1", "gnd": "1'b0"}
    nets = sorted({net for cell in block.cells for net in cell.pins.values()} - set(block.ports) - set(SUPPLIES))
    lines = ["// Generated from the mapped netlist.", f"module {block.name} ({', '.join(block.ports)});"]
    lines += [f"  {direction} {port};" for port, direction in block.ports.items()]
    lines += [f"  wire {net};" for net in nets]
    lines += [f"  {cell.kind} {cell.name} ("
              + ", ".join(f".{pin}({literal.get(net, net)})" for pin, net in cell.pins.items()) + ");"
              for cell in block.cells]
    return "\n".join([*lines, "endmodule", ""])


def pin_orders(extracted: str) -> dict[str, list[str]]:
    """Pins of every cell in the order of its subcircuit, which Netgen uses for empty cells."""
    return {line.split()[1]: line.split()[2:]
            for line in re.findall(r"^\.subckt .*$", extracted, re.IGNORECASE | re.MULTILINE)}


def spice(block: Block, orders: dict[str, list[str]]) -> str:
    """Netlist with which the layout is compared. It is made from the mapped netlist, not from any output of placement. Cells are empty,
    since the layout has them as abstracts, too."""
    kinds = {cell.kind: {*cell.pins, *SUPPLIES} for cell in block.cells}
    strange = sorted(kind for kind, pins in kinds.items() if set(orders.get(kind, ())) != pins)
    if strange:
        raise FlowError(f"{block.name}: the layout's {strange[0]} does not have the pins {', '.join(sorted(kinds[strange[0]]))}")
    lines = ["* Generated from the mapped netlist."]
    for kind in sorted(kinds):
        lines += [f".subckt {kind} {' '.join(orders[kind])}", f".ends {kind}"]
    lines += [f".subckt {block.name} {' '.join([*SUPPLIES, *block.ports])}"]
    for cell in block.cells:
        pins = cell.pins | dict(zip(SUPPLIES, SUPPLIES))
        lines.append(f"X{cell.name} {' '.join(pins[pin] for pin in orders[cell.kind])} {cell.kind}")
    return "\n".join([*lines, f".ends {block.name}", ".end", ""])


def pin_sides(block: Block) -> str:
    """graywolf's hints for the block's pins: those of the SRAM on the lower edge, where the SRAM would be, the others on the upper edge."""
    others = [port for port in block.ports if port not in set(block.sram_ports)]
    lines = []
    for side, (name, ports) in zip("BT", (("sram", block.sram_ports), ("column", others))):
        if ports:
            lines += [f"padgroup {name} permute", *(f"twpin_{port} nonfixed" for port in ports),
                      f"restrict side {side}"]
    return "\n".join([*lines, ""])
