# SPDX-License-Identifier: Apache-2.0
"""Resistance and capacitance of routed wires, for OpenSTA, and the wire-load model that they are compared with.

Lengths are the routed DEF's, resistances and the tree's shape the router's; a micrometre of a layer has the capacitance of
the LEF's layer: its area and both its edges. (The router's own file counts one edge, which halves the capacitance.)
"""

from __future__ import annotations

import re

from ..errors import FlowError
from ..liberty import THRESHOLDS, Group
from ..library import Library
from ..standard_cells import WIRE_UM_PER_FANOUT
from .block import CLOCK, SUPPLIES, Block
from .results import Branch, Layout, Tree

NODE_NM = 180
REFERENCE_NM = 40  # the generated library's, whose wire-load model is judged
MODEL = "scaled"


def scaled_um() -> float:
    """Wire length per sink of the flow's wire-load model, scaled to this technology, um."""
    return WIRE_UM_PER_FANOUT * NODE_NM / REFERENCE_NM


def layer_ff_per_um(lef: str) -> dict[str, float]:
    """Capacitance of every routing layer at its width, fF per um, from a technology LEF."""
    found = {}
    for name, body in re.findall(r"^LAYER (\S+)(.*?)^END \1", lef, re.DOTALL | re.MULTILINE):
        values = [re.search(rf"^\s*{key}\s+([\d.eE+-]+)", body, re.MULTILINE)
                  for key in ("WIDTH", r"CAPACITANCE\s+CPERSQDIST", "EDGECAPACITANCE")]
        if None not in values:
            width, area, edge = (float(value.group(1)) for value in values if value)
            found[name] = (width * area + 2 * edge) * 1000
    if not found:
        raise FlowError("the LEF has no routing layer with a width and capacitances")
    return found


def net_ff(layout: Layout, per_um: dict[str, float]) -> dict[str, float]:
    return {net: sum(wire.length * per_um[wire.layer] for wire in wires) for net, wires in layout.wires.items()}


def signal_nets(block: Block) -> set[str]:
    """Nets that the wire-load model describes: all signals except the clock, whose wires belong to its tree."""
    return {net for cell in block.cells for net in cell.pins.values()} - {CLOCK, *SUPPLIES}


def wire_load_liberty(ff_per_um: float) -> str:
    """A Liberty with nothing but the wire-load model, with this technology's capacitance."""
    library = Group("library", ["wires"], [
        ("delay_model", "table_lookup"), ("time_unit", '"1ns"'), ("voltage_unit", '"1V"'), ("current_unit", '"1uA"'),
        ("pulling_resistance_unit", '"1kohm"'), ("capacitive_load_unit", ["1", "pf"]), ("nom_voltage", "1.8"),
        *THRESHOLDS])
    library.add(Group("wire_load", [f'"{MODEL}"'], [
        ("capacitance", f"{ff_per_um / 1000:.6g}"), ("resistance", "0"), ("slope", f"{scaled_um():g}"),
        ("fanout_length", ["1", f"{scaled_um():g}"])]))
    return library.write() + "\n"


def _weight(branches: list[Branch]) -> float:
    return sum(branch.weight + _weight(branch.branches) for branch in branches)


def _ohm(branches: list[Branch]) -> float:
    return sum(branch.ohm + _ohm(branch.branches) for branch in branches)


def _undescribed(block: Block, drivers: dict[str, str], capacitance: dict[str, float], described: set[str],
                 ohm_per_ff: float) -> dict[str, Tree]:
    """Substitutes for the trees of routed nets between cells that are not `described`."""
    pins: dict[str, list[str]] = {}
    for cell in block.cells:
        for pin, net in cell.pins.items():
            pins.setdefault(net, []).append(f"{cell.name}/{pin}")
    found = {}
    for net in sorted((signal_nets(block) & set(capacitance)) - described):
        driver = next((pin for pin in pins.get(net, []) if pin in drivers), None)
        if driver is not None:
            sinks = [pin for pin in pins[net] if pin != driver] + ([net] if net in block.ports else [])
            found[net] = Tree(driver, [Branch(capacitance[net] * ohm_per_ff, 1.0, sinks)])
    return found


def spef(block: Block, library: Library, trees: dict[str, Tree], capacitance: dict[str, float]) -> str:
    """SPEF of the wires of all signal nets. A net that the router does not describe has all its pins at the end of one wire with the net's
    capacitance; its resistance per fF is that of the other nets."""
    lines = ['*SPEF "IEEE 1481-1998"', f'*DESIGN "{block.name}"', '*DATE "none"', '*VENDOR "none"', '*PROGRAM "none"',
             '*VERSION "none"', '*DESIGN_FLOW "none"', "*DIVIDER /", "*DELIMITER :", "*BUS_DELIMITER []", "*T_UNIT 1 NS",
             "*C_UNIT 1 FF", "*R_UNIT 1 OHM", "*L_UNIT 1 HENRY", ""]
    drivers = {f"{cell.name}/{pin}": "O" for cell in block.cells for pin in cell.pins
               if pin in library.max_load_ff[cell.kind]}
    described = signal_nets(block) & set(trees)
    measured = [net for net in described if net in capacitance]
    ohm_per_ff = sum(_ohm(trees[net].branches) for net in measured) / (sum(capacitance[net] for net in measured) or 1.0)
    trees = {**{net: trees[net] for net in described}, **_undescribed(block, drivers, capacitance, described, ohm_per_ff)}
    for net in sorted(trees):
        tree = trees[net]
        total = capacitance.get(net, 0.0)
        unit = total / (_weight(tree.branches) or 1.0)
        pins = [tree.driver]
        caps: list[str] = []
        ohms: list[str] = []
        nodes = 0

        def walk(start: str, branches: list[Branch]) -> None:
            nonlocal nodes
            for branch in branches:
                nodes += 1
                node = f"{net}:{nodes}"
                caps.append(f"{len(caps) + 1} {node} {branch.weight * unit:.6g}")
                ohms.append(f"{len(ohms) + 1} {start} {node} {branch.ohm:.6g}")
                for pin in branch.pins:
                    pins.append(pin)
                    ohms.append(f"{len(ohms) + 1} {node} {pin.replace('/', ':')} 0.001")
                walk(node, branch.branches)

        walk(tree.driver.replace("/", ":"), tree.branches)
        lines += [f"*D_NET {net} {total:.6g}", "*CONN"]
        for pin in pins:
            if "/" in pin:
                lines.append(f"*I {pin.replace('/', ':')} {drivers.get(pin, 'I')}")
            else:
                lines.append(f"*P {pin} {'I' if block.ports.get(pin) == 'input' else 'O'}")
        lines += ["*CAP", *caps, "*RES", *ohms, "*END", ""]
    return "\n".join(lines)
