# SPDX-License-Identifier: Apache-2.0
"""Stand-in for an array in the timed netlist of dtof_subsystem: a cell with the times of the array's ports.

OpenSTA measures each port on the array's own netlist, in each corner, without and with margins: at an input, how long before and after the
clock's edge it must be stable; at an output, when it changes first and last. The stand-in has these times as setup, hold, recovery and
removal times and as delays from the clock. Inputs have the array's loads. A port that no path reaches is a constant or is not connected in
the array, else the flow stops; so does a path through the array from an input to an output, which the stand-in could not have.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from . import tools
from .endpoints import SIDE_BAND
from .errors import FlowError, found_in
from .liberty import THRESHOLDS, Group
from .run import STAND_IN_LIBERTY, Result
from .standard_cells import CINV_FF, FO4_NS
from .technology import Technology
from .timing import Netlist

CELL = "array_stand_in"
CLOCK = "clk_i"
RESET = "rst_ni"
MODES = ("nominal", "margins")
LATE, EARLY = 1.05, 0.95  # constraints/margins.sdc: cells that are late, and early
SETUP_UNCERTAINTY = {"nominal": 0.10, "margins": 0.15}  # of the clock, in dtof.sdc and margins.sdc
HOLD_UNCERTAINTY = 0.05
SHARE, RESET_SHARE = 0.30, 0.20  # of the period, that constraints/dtof.sdc leaves outside the array
_PORT = re.compile(r"^DTOF_PORT (\w+) (\S+) (in|out) (\S+) (\S+) (\d+)$", re.MULTILINE)
_LOAD = re.compile(r"^Net (\S+)\n Pin capacitance: .*\n Wire capacitance: .*\n Total capacitance: (\S+)", re.MULTILINE)


@dataclass(frozen=True)
class Port:
    """Times of one bit of a port, ns. Of an input: `late` is the setup time, `early` the hold time. Of an output: `late` and `early` are the
    longest and the shortest delay from the clock. `load_ff`: of an input."""

    name: str
    is_output: bool
    late: float
    early: float
    load_ff: float = 0.0

    @property
    def pin(self) -> str:
        return plain(self.name)


def plain(name: str) -> str:
    """Name of the stand-in's pin for a bit of a port, `port` or `port[bit]`."""
    return re.sub(r"\[(\d+)\]", r"_\1_", name)


@dataclass(frozen=True)
class Ports:
    """Ports with paths, by MODES; `constant`: outputs that never change; `unused`: inputs that the array does not use."""

    timed: dict[str, list[Port]]
    constant: set[str]
    unused: set[str]


def _times(mode: str, period: float, name: str, is_output: bool, setup_slack: float, hold_slack: float) -> tuple[float, float]:
    """(late, early) of a port from its slacks with the budgets of constraints/dtof.sdc."""
    budget = (RESET_SHARE if name == RESET else SHARE) * period
    late = period - SETUP_UNCERTAINTY[mode] - budget - setup_slack
    if is_output:
        return late, hold_slack + HOLD_UNCERTAINTY - budget
    return late, budget - HOLD_UNCERTAINTY - hold_slack


def parse(name: str, output: str, period: float) -> Ports:
    """Ports from the output of synth/subsystem/array_times.tcl."""
    through = output.split("DTOF_THROUGH\n", 1)[1].split("DTOF_END", 1)[0]
    if "Startpoint" in through:
        start, end = (found_in("OpenSTA", rf"{what}: (\S+)", through)[1] for what in ("Startpoint", "Endpoint"))
        raise FlowError(f"{name}: a path through the array from {start} to {end} has no arc in the array's stand-in")
    loads = {net: float(load) for net, load in _LOAD.findall(output)}
    found = Ports({mode: [] for mode in MODES}, set(), set())
    for mode, port, way, setup, hold, pins in _PORT.findall(output):
        is_output = way == "out"
        if setup.lower() != "inf":
            late, early = _times(mode, period, port, is_output, float(setup), float(hold))
            found.timed[mode].append(Port(port, is_output, late, early, 0.0 if is_output else loads[port]))
        elif SIDE_BAND.fullmatch(port):
            continue
        elif is_output:
            found.constant.add(port)  # the array's own run checks that it is
        elif int(pins):
            raise FlowError(f"{name}: no path begins at the array's port {port}, although {pins} pins are connected to it")
        else:
            found.unused.add(port)
    if not all(found.timed.values()):
        raise FlowError(f"{name}: no port of the array is timed")
    return found


def _timing(kind: str, values: Iterable[tuple[str, float]]) -> Group:
    return Group("timing", [], [("related_pin", f'"{CLOCK}"'), ("timing_type", kind)],
                 [Group(table, ["scalar"], [("values", [f'"{value:.5f}"'])]) for table, value in values])


def _delay(value: float) -> Group:
    return _timing("rising_edge", [("cell_rise", value), ("cell_fall", value), ("rise_transition", FO4_NS), ("fall_transition", FO4_NS)])


def liberty(ports: Iterable[Port], others: Iterable[tuple[str, bool]], mode: str, voltage: float) -> str:
    """Liberty of the stand-in. `others`: names of pins without times, and whether they are outputs. With margins OpenSTA makes delays of
    the stand-in longer or shorter once more, as it does with every cell's; so they are divided by that here."""
    late, early = (LATE, EARLY) if mode == "margins" else (1.0, 1.0)
    library = Group("library", ["array"], [("delay_model", "table_lookup"), ("time_unit", '"1ns"'), ("voltage_unit", '"1V"'),
                                           ("current_unit", '"1mA"'), ("capacitive_load_unit", ["1", "ff"]),
                                           ("nom_voltage", f"{voltage}"), *THRESHOLDS])
    cell = library.add(Group("cell", [CELL], [("area", "0")]))
    cell.add(Group("pin", [CLOCK], [("direction", "input"), ("clock", "true"), ("capacitance", f"{CINV_FF:.4f}")]))
    for port in ports:
        pin = cell.add(Group("pin", [port.pin], [("direction", "output" if port.is_output else "input")]))
        if port.is_output:
            pin.groups = [_delay(port.late / late), _delay(port.early / early)]
        else:
            pin.attributes.append(("capacitance", f"{port.load_ff:.4f}"))
            kinds = ("recovery_rising", "removal_rising") if port.name == RESET else ("setup_rising", "hold_rising")
            pin.groups = [_timing(kind, [("rise_constraint", value), ("fall_constraint", value)])
                          for kind, value in zip(kinds, (port.late, port.early))]
    for name, is_output in others:
        cell.add(Group("pin", [plain(name)], [("direction", "output" if is_output else "input"), ("capacitance", "0")]))
    return library.write() + "\n"


def measure(result: Result, technology: Technology, folder: Path, corner: str) -> Ports:
    """Times of the ports of the array that run.run left in `folder`. They are kept there until the array or the libraries change."""
    effort = folder / f"effort{result.effort}"
    library = technology.library(corner)
    root, period = technology.root, 1e3 / technology.target_mhz
    files = Netlist(f"{result.configuration.name}, {corner} corner", effort / "timing.v", effort / f"wires_{corner}.spef",
                    [library.path, technology.kit / f"sram40_{corner}.lib", effort / STAND_IN_LIBERTY], library.wire_load,
                    result.configuration.top)
    script = root / "synth" / "subsystem" / "array_times.tcl"
    constraints, margins = (root / "constraints" / name for name in ("dtof.sdc", "margins.sdc"))
    digest = hashlib.sha256()
    for file in (files.verilog, files.wires, *files.liberty_files, script, constraints, margins, Path(__file__)):
        digest.update(hashlib.sha256(file.read_bytes()).digest())
    kept = folder / f"ports_{corner}.json"
    if kept.is_file():
        table = json.loads(kept.read_text(encoding="utf-8"))
        if table["digest"] == digest.hexdigest():
            return Ports({mode: [Port(**port) for port in table[mode]] for mode in MODES}, set(table["constant"]), set(table["unused"]))
    settings, log = folder / f"array_times_{corner}.tcl", folder / f"array_times_{corner}.log"
    tools.write_settings(settings, {
        "liberty_files": files.liberty_files, "netlist": files.verilog, "wires": files.wires, "top": files.top,
        "wire_load": files.wire_load, "period": f"{period:.6f}", "constraints": constraints, "margins": margins,
        "slew": f"{FO4_NS:.4f}", "load": f"{10 * CINV_FF:.4f}"})
    found = parse(files.name, tools.run_sta(script, settings, log, files.name), float(f"{period:.6f}"))
    kept.write_text(json.dumps({"digest": digest.hexdigest(), "constant": sorted(found.constant), "unused": sorted(found.unused),
                                **{mode: [asdict(port) for port in found.timed[mode]] for mode in MODES}}), encoding="utf-8")
    return found
