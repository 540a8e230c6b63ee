# SPDX-License-Identifier: Apache-2.0
"""Ends of paths in the netlist of dtof_subsystem: how many there are, and whether OpenSTA timed all of them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from . import array_stand_in, endpoints, netlist
from .array_stand_in import MODES, Ports
from .errors import FlowError, given
from .library import Library

ARRAY = "u_array"  # name of the array's instance in the timed netlist
_END = re.compile(r"^(\S+) \(\S+\) +\S+ +\S+ +(-?[\d.]+) \((?:MET|VIOLATED)\)$", re.MULTILINE)
_SLOW_EDGE = re.compile(r"^(\S+/\S+) .*\(VIOLATED\)$", re.MULTILINE)
_ASKED = re.compile(r"^DTOF_ASKED (\S+)\n\S+ ([01X])$", re.MULTILINE)


@dataclass(frozen=True)
class Ends:
    """Ends of paths. `all`: pins with a setup time, the array's included, and output ports; not timed are those that hang on a constant, and
    the side band. `to_array` and `from_array`: pins of the array, counted as timed. `resets`: pins with a recovery time, all timed."""

    all: int
    timed: int
    constant: int
    side_band: int
    to_array: int
    from_array: int
    resets: int


def _reset_pins(library: Library) -> set[str]:
    return {"RN", "SN"} & {pin for kind in library.sequential for pin in library.input_ff[kind]}


def count_ends(design: dict, library: Library, ports: Ports) -> tuple[int, int]:
    """(pins with a setup time and output ports, pins with a recovery time) of the netlist."""
    resets = _reset_pins(library)

    def of(module: dict) -> tuple[int, int]:
        ends = asynchronous = 0
        for cell in module["cells"].values():
            inner = netlist.modules(design).get(cell["type"])
            if inner and inner["cells"]:
                more = of(inner)
                ends, asynchronous = ends + more[0], asynchronous + more[1]
            ends += len(library.checked.get(cell["type"], ()))
            asynchronous += len(resets & cell["connections"].keys())
        return ends, asynchronous

    ends, asynchronous = of(netlist.top(design))
    inputs = [port for port in ports.timed[MODES[0]] if not port.is_output]
    outputs = sum(len(port["bits"]) for port in netlist.top(design)["ports"].values() if port["direction"] == "output")
    return (ends + outputs + sum(port.name != array_stand_in.RESET for port in inputs),
            asynchronous + sum(port.name == array_stand_in.RESET for port in inputs))


def timed_ends(output: str, kind: str) -> tuple[dict[str, float], dict[str, float]]:
    """Slacks of the ends that OpenSTA timed, from the output of synth/subsystem/ends.tcl: those of data, and those of the reset. `kind`: max or
    min."""
    listing = output.split(f"DTOF_ENDS_{kind}\n", 1)[1].split("DTOF_END\n", 1)[0]
    data: dict[str, float] = {}
    resets: dict[str, float] = {}
    for group in re.split(r"^(?=max_delay|min_delay)", listing, flags=re.MULTILINE):
        own = resets if "async_default" in group.split("\n", 1)[0] else data
        own.update((end, float(slack)) for end, slack in _END.findall(group))
    return data, resets


def pins_of_slow_edges(output: str) -> list[str]:
    """Pins in the output of synth/subsystem/edges.tcl."""
    listing = given(re.search(r"^DTOF_EDGES\n(.*?)^DTOF_END$", output, re.MULTILINE | re.DOTALL), "OpenSTA: no list of transitions")
    return _SLOW_EDGE.findall(listing[1])


def judge_ends(name: str, counted: tuple[int, int], unchecked: dict[str, list[str]], output: str, ports: Ports) -> Ends:
    """Compares the ends in the netlist with those that OpenSTA timed. `counted`: from count_ends; `unchecked`: warnings of check_setup. FlowError
    if an end is not timed and is neither constant nor part of the side band, for every other warning, and if pins of the array are not timed."""
    constants = {end for end, value in _ASKED.findall(output) if value != "X"}
    constant = side_band = 0
    for warning, pins in unchecked.items():
        unexplained = []
        for pin in pins or [""]:
            if warning.startswith("unconstrained endpoint") and endpoints.SIDE_BAND.fullmatch(pin):
                side_band += 1
            elif warning.startswith("unconstrained endpoint") and pin in constants:
                constant += 1
            else:
                unexplained.append(pin)
        if unexplained:
            raise FlowError(f"{name}: OpenSTA warns of {len(unexplained)} {warning}: {', '.join(unexplained[:5])}"
                            + (" and others" if len(unexplained) > 5 else ""))
    to_array = sum(not port.is_output for port in ports.timed[MODES[0]])
    found = Ends(counted[0], counted[0] - constant - side_band, constant, side_band, to_array,
                 sum(port.is_output for port in ports.timed[MODES[0]]), counted[1])
    for kind, what in (("max", "setup"), ("min", "hold")):
        data, resets = timed_ends(output, kind)
        at_array = sum(end.startswith(f"{ARRAY}/") for end in data) + (f"{ARRAY}" in resets or f"{ARRAY}/{array_stand_in.RESET}" in resets)
        if at_array != to_array:
            raise FlowError(f"{name}: OpenSTA times {at_array} of {to_array} pins of the array for {what}")
        if len(data) != found.timed or len(resets) != found.resets:
            raise FlowError(f"{name}: OpenSTA times {len(data)} of {found.timed} ends and {len(resets)} of {found.resets} resets for {what}")
    return found
