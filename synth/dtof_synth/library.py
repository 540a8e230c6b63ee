# SPDX-License-Identifier: Apache-2.0
"""Facts about a standard-cell library that the flow needs, read from its Liberty."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from . import liberty
from .errors import FlowError
from .liberty import Group


@dataclass(frozen=True)
class Buffer:
    """A buffer cell; loads in fF."""

    name: str
    input_pin: str
    output_pin: str
    area: float
    input_ff: float
    max_load_ff: float


@dataclass(frozen=True)
class ClockGate:
    """An integrated clock gate: a latch that is open while the clock is low, and an AND."""

    name: str
    clock_pin: str
    enable_pin: str
    output_pin: str
    area: float
    max_load_ff: float


@dataclass
class Library:
    """Cells of one Liberty. Areas in um2 as the Liberty has them, capacitances in fF."""

    path: Path
    name: str
    area: dict[str, float]
    sequential: set[str]
    latches: set[str]
    input_ff: dict[str, dict[str, float]]
    max_load_ff: dict[str, dict[str, float]]
    buffers: list[Buffer]
    inverter: str
    tie: dict[str, tuple[str, str]]
    nand2_area: float
    mux2_area: float
    voltage: float
    wire_load: str
    wire_ff_per_sink: float
    clock_pin_ff: dict[str, float] = field(default_factory=dict)
    clock_energy_fj: dict[str, float] = field(default_factory=dict)
    energy_fj: float = 1.0  # the Liberty's unit of energy
    clock_gates: list[ClockGate] = field(default_factory=list)  # smallest first
    checked: dict[str, set[str]] = field(default_factory=dict)  # pins of a cell that have a setup time
    drives: list[list[str]] = field(default_factory=list)  # cells of one function and the same pins, smallest first

    @property
    def smaller(self) -> dict[str, str]:
        """For each cell, the same cell with the next smaller drive, if there is one."""
        return {name: before for family in self.drives for before, name in zip(family, family[1:])}


def _capacitance_unit_ff(library: Group, where: Path) -> float:
    for name, value in library.attributes:
        if name == "capacitive_load_unit" and isinstance(value, list) and len(value) == 2:
            scale = {"ff": 1.0, "pf": 1000.0}.get(value[1].lower())
            if scale:
                return float(value[0]) * scale
    raise FlowError(f"{where}: no capacitive_load_unit in ff or pf")


def _function(pin: Group) -> str:
    """The function without blanks, brackets and prime notation; a blank between names is an AND."""
    text = re.sub(r"(?<=\w)\s+(?=\w)", "*", pin.get("function"))
    text = text.replace(" ", "").replace("(", "").replace(")", "")
    return re.sub(r"(\w+)'", r"!\1", text)


def _wire_load(library: Group, unit: float) -> tuple[str, float]:
    """(name, fF per sink) of the default wire load, or of the one named for a thousand gates; (empty, 0) without one."""
    loads = {group.name: group for group in library.children("wire_load")}
    name = library.get("default_wire_load")
    if name not in loads:
        name = next((key for key in loads if "1K" in key), "")
    if not name:
        return "", 0.0
    lengths = [value for key, value in loads[name].attributes if key == "fanout_length"]
    return name, float(lengths[0][1]) * loads[name].number("capacitance") * unit


def _nand2_area(cells: list[Group]) -> float:
    areas = []
    for cell in cells:
        outputs = [pin for pin in cell.children("pin") if pin.get("direction") == "output"]
        if len(outputs) == 1 and re.fullmatch(r"!(\w+[*&]\w+|\w+\+!\w+)", _function(outputs[0])):
            areas.append(cell.number("area"))
    return min(areas, default=0.0)


def _mux2_area(cells: list[Group]) -> float:
    """Area of a two-input multiplexer, found by cell name, since libraries write its function in many ways."""
    return min((cell.number("area") for cell in cells if re.search("mux2", cell.name, re.IGNORECASE)), default=0.0)


def _internal_clock_energy(pin: Group) -> float:
    """Energy of one clock cycle inside a register: rise and fall at the smallest slew, mean over all states."""
    powers = pin.children("internal_power")
    tables = [table for power in powers for table in power.groups]
    firsts = [value[0] for table in tables for key, value in table.attributes if key == "values"]
    return sum(float(text.split(",")[0]) for text in firsts) / max(len(powers), 1)


def _drives(cells: list[Group]) -> list[list[str]]:
    """Groups of cells whose names differ in the last number only: in all libraries here it is the drive."""
    families: dict[tuple, set[tuple[float, str]]] = {}
    for cell in cells:
        stem = re.fullmatch(r"(.*?)\d+", cell.name)
        pins = tuple(sorted((pin.name, pin.get("direction"), _function(pin)) for pin in cell.children("pin")))
        if stem and pins:
            families.setdefault((stem.group(1), pins), set()).add((cell.number("area"), cell.name))
    return [[name for _, name in sorted(family)] for family in families.values() if len(family) > 1]


def _clock_gate(cell: Group, unit: float) -> ClockGate | None:
    """The cell as a clock gate; None unless it is for rising-edge registers and without a pin for scan mode."""
    if cell.get("clock_gating_integrated_cell").strip('"') != "latch_posedge":
        return None
    clock, enable, output = (next((pin for pin in cell.children("pin") if pin.get(f"clock_gate_{role}_pin").strip('"') == "true"), None)
                             for role in ("clock", "enable", "out"))
    if clock is None or enable is None or output is None:
        return None
    return ClockGate(cell.name, clock.name, enable.name, output.name, cell.number("area"), output.number("max_capacitance") * unit)


def read(path: Path) -> Library:
    """Reads a library. FlowError if the file is no Liberty, or lacks an inverter, buffer, NAND2 or flip-flop."""
    root = liberty.read(path)
    unit = _capacitance_unit_ff(root, path)
    cells = root.children("cell")
    result = Library(path, root.name, {}, set(), set(), {}, {}, [], "", {}, _nand2_area(cells),
                     _mux2_area(cells), root.number("nom_voltage"), *_wire_load(root, unit), energy_fj=unit, drives=_drives(cells))
    inverters: list[tuple[float, str]] = []
    for cell in cells:
        name, area = cell.name, cell.number("area")
        if name in result.area:
            continue
        result.area[name] = area
        pins = cell.children("pin")
        inputs = [pin for pin in pins if pin.get("direction") == "input"]
        outputs = [pin for pin in pins if pin.get("direction") == "output"]
        result.input_ff[name] = {pin.name: pin.number("capacitance") * unit for pin in inputs}
        result.max_load_ff[name] = {pin.name: pin.number("max_capacitance") * unit for pin in outputs}
        checked = {pin.name for pin in pins for arc in pin.children("timing") if arc.get("timing_type").strip('"').startswith("setup")}
        if checked:
            result.checked[name] = checked
        gate = _clock_gate(cell, unit)
        if gate is not None:
            clock = next(pin for pin in inputs if pin.name == gate.clock_pin)
            result.clock_pin_ff[name] = clock.number("capacitance") * unit
            result.clock_energy_fj[name] = _internal_clock_energy(clock) * unit
            result.clock_gates = sorted([*result.clock_gates, gate], key=lambda one: (one.area, one.name))
            continue
        if cell.children("ff"):
            result.sequential.add(name)
            edge = next((pin for pin in inputs if pin.get("clock") == "true"), None)
            if edge is not None:
                result.clock_pin_ff[name] = edge.number("capacitance") * unit
                result.clock_energy_fj[name] = _internal_clock_energy(edge) * unit
        elif cell.children("latch"):
            result.latches.add(name)
        elif len(outputs) == 1:
            function = _function(outputs[0])
            if len(inputs) == 1 and function == f"!{inputs[0].name}":
                inverters.append((area, name))
            elif len(inputs) == 1 and function == inputs[0].name and not name.upper().startswith("CLK"):
                result.buffers.append(Buffer(name, inputs[0].name, outputs[0].name, area,
                                             result.input_ff[name][inputs[0].name],
                                             result.max_load_ff[name][outputs[0].name]))
            elif not inputs and function in ("0", "1"):
                result.tie.setdefault(function, (name, outputs[0].name))
    result.buffers.sort(key=lambda buffer: (buffer.max_load_ff, buffer.area))
    result.inverter = min(inverters, default=(0.0, ""))[1]
    missing = [what for what, found in (("inverter", result.inverter), ("buffer", result.buffers),
                                        ("NAND2", result.nand2_area), ("flip-flop", result.sequential))
               if not found]
    if missing:
        raise FlowError(f"{path}: the library has no {' and no '.join(missing)}")
    return result
