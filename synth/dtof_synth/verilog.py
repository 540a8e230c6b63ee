# SPDX-License-Identifier: Apache-2.0
"""Mapped netlists as the plain Verilog that OpenSTA reads: instances and wires alone, every cell and port with a plain name.

Yosys writes the same; it takes seconds for an array, and timing writes one after each repair.
"""

from __future__ import annotations

import re

from . import netlist
from .errors import FlowError
from .netlist import Module

_PLAIN = re.compile(r"[A-Za-z_]\w*")


def _range(port: dict) -> str:
    offset = port.get("offset", 0)
    width = len(port["bits"])
    return f" [{offset + width - 1}:{offset}]" if width > 1 or offset else ""


def _plain(name: str) -> str:
    if not _PLAIN.fullmatch(name):
        raise FlowError(f"netlist: '{name}' needs an escape in Verilog")
    return name


def _module(name: str, module: Module) -> list[str]:
    named: dict[int, str] = {}
    ports, aliases = [], []
    for port, description in module["ports"].items():
        ports.append(f"  {description['direction']}{_range(description)} {_plain(port)};")
        for index, bit in enumerate(description["bits"]):
            own = f"{port}[{index + description.get('offset', 0)}]" if _range(description) else port
            if isinstance(bit, int) and bit not in named:
                named[bit] = own
            else:  # a constant, or an input handed on
                aliases.append(f"  assign {own} = {named[bit] if isinstance(bit, int) else _constant(bit)};")
    wires: dict[int, str] = {}
    for net, description in module["netnames"].items():
        if net.startswith("wire_") and len(description["bits"]) == 1:
            wires[description["bits"][0]] = net

    def of(bit: int | str) -> str:
        if not isinstance(bit, int):
            return _constant(bit)
        return named.get(bit) or wires.setdefault(bit, f"net_{bit}")

    cells = []
    for cell, description in module["cells"].items():
        pins = [f".{pin}({of(bits[0]) if len(bits) == 1 else '{' + ', '.join(map(of, reversed(bits))) + '}'})"
                for pin, bits in description["connections"].items()]
        cells.append(f"  {_plain(description['type'])} {_plain(cell)} ({', '.join(pins)});")
    return [f"module {_plain(name)} ({', '.join(module['ports'])});", *ports,
            *(f"  wire {wire};" for bit, wire in wires.items() if bit not in named), *aliases, *cells, "endmodule", ""]


def _constant(bit: str) -> str:
    return f"1'b{bit}"


def write(design: dict) -> str:
    """Verilog of all modules with cells. Macros, library cells and stubs come from the libraries."""
    return "\n".join(line for name, module in netlist.modules(design).items() if module["cells"]
                     for line in _module(name, module))
