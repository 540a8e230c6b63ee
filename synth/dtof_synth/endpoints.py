# SPDX-License-Identifier: Apache-2.0
"""Checks that every end of a path is timed, or has a reason not to be.

OpenSTA's check_setup lists data pins that no path reaches, registers without a clock, ports without a budget, and loops. Each entry must
have one of three reasons, else the flow stops:

* side band: constraints/dtof.sdc excludes the SRAMs' side band from timing, since it is idle while the array works;
* constant: the pin is connected to a constant, so that no path ends there;
* inside: the pin is a stand-in's, and its paths begin in logic that the stand-in lacks (stand_in.py). The same pin of a real column has
these paths.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from . import netlist
from .errors import FlowError, found_in
from .library import Library
from .netlist import Module

SIDE_BAND = re.compile(r"sram_cfg_[io](\[\d+\])?")
_MOST_NAMED = 5


@dataclass(frozen=True)
class Endpoints:
    """Numbers of data pins and output ports in the timed netlist (without stand-ins' pins of internal paths), and of those that are timed.
    The others are constant or belong to the side band."""

    all: int
    timed: int
    constant: int
    side_band: int


class _Constants:
    """Finds pins that are connected to constants only."""

    def __init__(self, design: dict, library: Library) -> None:
        self.design = design
        self.ties = {kind for kind, _ in library.tie.values()}
        self.library = library
        self.drivers: dict[str, dict[int, str]] = {}

    def _driver(self, kind: str, bit: int) -> str | None:
        if kind not in self.drivers:
            module = netlist.modules(self.design)[kind] if kind else netlist.top(self.design)
            self.drivers[kind] = {bit: name for name, cell in module["cells"].items() for pin, bits in cell["connections"].items()
                                  if cell["port_directions"].get(pin) == "output" for bit in bits if isinstance(bit, int)}
        return self.drivers[kind].get(bit)

    def has(self, name: str) -> bool:
        """True if a pin or port, named as in OpenSTA, is constant."""
        array = netlist.top(self.design)
        if "/" not in name:
            port, index = found_in("OpenSTA", r"^(\w+)(?:\[(\d+)\])?$", name).groups()
            description = array["ports"][port]
            return self._net("", "", description["bits"][int(index or 0) - description.get("offset", 0)])
        *block, _, _ = name.split("/")
        kind, cell, pin = netlist.local_pin(self.design, name)
        module = netlist.modules(self.design)[kind] if kind else array
        bits = module["cells"][cell]["connections"].get(pin.split("[")[0], [])
        index = int(pin[pin.index("[") + 1:-1]) if "[" in pin else 0
        return bool(bits) and self._net(block[0] if block else "", kind, bits[index])

    def _net(self, block: str, kind: str, bit: int | str) -> bool:
        """True if a net of an instance of a module, or of the top, is constant."""
        if not isinstance(bit, int):
            return True
        driver = self._driver(kind, bit)
        module = netlist.modules(self.design)[kind] if kind else netlist.top(self.design)
        if driver is None:
            for port, description in module["ports"].items():
                if block and bit in description["bits"] and description["direction"] == "input":
                    outer = netlist.top(self.design)["cells"][block]["connections"].get(port)
                    return outer is not None and self._net("", "", outer[description["bits"].index(bit)])
            return False
        cell = module["cells"][driver]
        if cell["type"] in self.ties:
            return True
        if cell["type"] not in self.library.area or cell["type"] in self.library.sequential | self.library.latches:
            return False
        inputs = [net for pin, bits in cell["connections"].items() if cell["port_directions"].get(pin) != "output" for net in bits]
        return bool(inputs) and all(self._net(block, kind, net) for net in inputs)


def count(design: dict, library: Library) -> int:
    """Number of pins with a setup time in all instances, and of output ports. Every input of a macro but its clock has a setup time."""

    def of(module: Module) -> int:
        number = 0
        for cell in module["cells"].values():
            kind = cell["type"]
            if kind in netlist.modules(design) and netlist.modules(design)[kind]["cells"]:
                if kind not in inner:
                    inner[kind] = of(netlist.modules(design)[kind])
                number += inner[kind]
            elif kind.startswith("sram_"):
                number += sum(len(bits) for pin, bits in cell["connections"].items()
                              if cell["port_directions"][pin] == "input" and pin != "clk_i")
            else:
                number += len(library.checked.get(kind, ()))
        return number

    inner: dict[str, int] = {}
    array = netlist.top(design)
    return of(array) + sum(len(port["bits"]) for port in array["ports"].values() if port["direction"] == "output")


def judge(name: str, unchecked: dict[str, list[str]], design: dict, library: Library, inside: Iterable[str]) -> Endpoints:
    """Counts the ends of paths. `unchecked`: warnings of check_setup; `design`: as OpenSTA read it; `inside`: the stand-ins' pins without
    paths. FlowError for a warning without one of the reasons above."""
    inside, constants = set(inside), _Constants(design, library)
    counted = {"inside": 0, "constant": 0, "side band": 0}
    for warning, pins in unchecked.items():
        unexplained = []
        for pin in pins or [""]:
            reason = ""
            if warning.startswith("unconstrained endpoint"):
                reason = ("inside" if pin in inside else "side band" if SIDE_BAND.fullmatch(pin)
                          else "constant" if constants.has(pin) else "")
            if reason:
                counted[reason] += 1
            else:
                unexplained.append(pin)
        if unexplained:
            raise FlowError(f"{name}: OpenSTA warns of {len(unexplained)} {warning}: {', '.join(unexplained[:_MOST_NAMED])}"
                            + (" and others" if len(unexplained) > _MOST_NAMED else ""))
    all_ends = count(design, library) - counted["inside"]
    return Endpoints(all_ends, all_ends - counted["constant"] - counted["side band"], counted["constant"], counted["side band"])
