# SPDX-License-Identifier: Apache-2.0
"""Area, timing and power of dtof_subsystem around an array. The array is a black box while the subsystem is mapped, and a cell with the array's
measured times (array_stand_in.py) while it is timed.

The parts of dtof_subsystem stay modules, so that each has an area of its own; what is inside them is flattened. A path of dtof_subsystem (PATHS),
which only connects parts, becomes a piece of dtof_subsystem itself. The names of the parts come from the elaborated netlist. Registers with a common enable get clock gates, as in the columns, except those of dtof_subsystem itself.
All wires have the library's wire load: there is no floorplan of the subsystem.
"""

from __future__ import annotations

import json
import math
import pickle
import re
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple, dataclass
from pathlib import Path

from . import (array_stand_in, clock_gating, endpoints, floorplan, loads, mapping, netlist, run, spef, sram_kit, subsystem_power, timing, tools,
               verilog)
from .array_stand_in import MODES, Ports
from .canonical import canonical
from .configuration import Configuration, macro_sizes
from .errors import FlowError, given
from .library import Library
from .mapping import Effort
from .netlist import Counts
from .run import Result
from .standard_cells import CINV_FF, FO4_NS
from .subsystem_ends import ARRAY, Ends, count_ends, judge_ends, pins_of_slow_edges, timed_ends
from .subsystem_power import SubsystemPower
from .technology import Technology
from .timing import Margin

TOP = "dtof_subsystem"
CONFIGURATIONS = ("ezpointer", "hispointer", "coarsehistogram", "poolpointer", "poolpointer_lean")
ARRAYS = ("dtof_array", "dtof_pool_pointer_array")
PATHS = ("dtof_line_path", "dtof_gated_array", "dtof_result_path", "dtof_optional_self_test")
CLOCK_GATE = "dtof_clock_gate"
CORNERS = ("slow", "typical", "fast")
EFFORTS = (mapping.LAYOUT_EFFORT, mapping.EFFORTS[-1])  # the first that closes with margins is taken, else the one that misses by least
HOLD_ROUNDS = 4
RESIZE_ROUNDS = 3
EDGE_ROUNDS = 4
SEED = 1  # of the simulation for the power
_INSTANCE = re.compile(r"^  cell (\S+) (\S+)$", re.MULTILINE)


@dataclass(frozen=True)
class Part:
    """A module of the subsystem: instances, and the cells of all of them together."""

    name: str
    instances: int
    counts: Counts


@dataclass(frozen=True)
class Slacks:
    """Slacks of a corner in ns at the target clock; `reset`: the lesser of recovery and removal."""

    setup: float
    hold: float
    reset: float
    start: str  # of the slowest path
    end: str


@dataclass(frozen=True)
class Subsystem:
    """Figures of the subsystem around one array."""

    configuration: Configuration
    parts: list[Part]  # the largest first
    array_mm2: float
    slacks: dict[tuple[str, str], Slacks]  # by corner and one of MODES
    ends: Ends
    late: dict[str, float]  # least setup slack with margins of the ends in each module, slow corner; with the array's
    slow_edges: dict[str, int]  # by corner: pins beyond the library's max_transition
    overloaded: list[str]  # drivers inside modules with more load than max_capacitance, or with too many inputs
    target_mhz: float
    power: SubsystemPower

    @property
    def counts(self) -> Counts:
        return Counts(*(sum(values) for values in zip(*(astuple(part.counts) for part in self.parts))))

    @property
    def mm2(self) -> float:
        return self.counts.area / 1e6

    @property
    def share(self) -> float:
        """Area of the subsystem around the array, over that of the array."""
        return self.mm2 / self.array_mm2

    def part(self, name: str) -> Part:
        found = next((part for part in self.parts if part.name == name), None)
        return given(found, f"{self.configuration.name}: {TOP} has no module {name}")

    def worst(self, mode: str) -> float:
        """The least slack of all corners and kinds, ns."""
        return min(min(one.setup, one.hold, one.reset) for (_, of), one in self.slacks.items() if of == mode)


def parameters(configuration: Configuration, root: Path) -> dict[str, int]:
    """Parameters of dtof_subsystem for the array of a configuration."""
    if not configuration.is_pool:
        return configuration.rtl_parameters()
    text = (root / "hdl" / "common" / "dtof_readouts.svh").read_text(encoding="utf-8")
    number = re.search(r"READOUT_POOLPOINTER = (\d+);", text)
    return {"READOUT": int(given(number, "dtof_readouts.svh: no READOUT_POOLPOINTER")[1]), **configuration.rtl_parameters()}


def clock_gate(library: Library) -> str:
    """The technology folder's clock gate with the library's cell, which has no pin for scan mode."""
    gate = given(next(iter(library.clock_gates), None), "the library has no clock gate")
    return "\n".join([
        "// SPDX-License-Identifier: Apache-2.0", "// Generated.", f"module {CLOCK_GATE} #(", "    parameter int NEEDED = 0", ") (",
        "    input  logic clk_i,", "    input  logic enable_i,", "    input  logic scan_mode_i,", "    output logic clk_o", ");",
        f"  {gate.name} u_gate (.{gate.clock_pin}(clk_i), .{gate.enable_pin}(enable_i || scan_mode_i), .{gate.output_pin}(clk_o));",
        "endmodule", ""])


def module_patterns() -> dict[str, tools.Setting]:
    """What elaborate.tcl leaves out, and what it makes a piece of the top: patterns of names of modules."""
    return {"array_modules": [f"*{name}" for name in ARRAYS], "path_modules": [f"*{name}*" for name in PATHS]}


def children(elaborated: str) -> list[str]:
    """Modules that the top of an elaborated netlist (RTLIL) instantiates, by their names in the RTL, without array and clock gate."""
    start = re.search(r"^attribute \\top .*\n(?:attribute .*\n)*module .*\n", elaborated, re.MULTILINE)
    body = elaborated[given(start, "the elaborated netlist has no top").end():].split("\nend\n", 1)[0]
    found = {plain_module(kind) for kind, _ in _INSTANCE.findall(body) if re.match(r"\\|\$paramod", kind)}
    return sorted(found - {CLOCK_GATE, *ARRAYS})


def plain_module(name: str) -> str:
    """Name in the RTL of a module that Yosys derived from it."""
    return next((part for part in name.split("\\") if re.fullmatch(r"[a-z]\w*", part)), name)


def generic(configuration: Configuration, technology: Technology, folder: Path) -> None:
    """Turns the RTL into the technology-independent netlist generic.il with clock gates. Checks must pass."""
    folder.mkdir(parents=True, exist_ok=True)
    root = technology.root
    black_boxes, *technology_files = sram_kit.write_rtl_views(
        folder, macro_sizes(configuration))
    gate = folder / f"{CLOCK_GATE}.sv"
    gate.write_text(clock_gate(technology.slow), encoding="utf-8")
    elaborated = folder / "elaborated.il"
    settings: dict[str, tools.Setting] = {
        "scripts": root / "synth" / "yosys", "top": TOP, "rtl_files": list(mapping.rtl_files(root)), "rtl_include": root / "hdl" / "common",
        "technology_files": [*technology_files, gate], "black_boxes": black_boxes, "liberty": technology.slow.path,
        "parameters": dict(parameters(configuration, root)), **module_patterns(),
        "elaborated_netlist": elaborated, "generic_netlist": folder / "generic.il"}
    written = folder / "generic_settings.tcl"
    tools.write_settings(written, settings)
    tools.run_yosys(root / "synth" / "subsystem" / "elaborate.tcl", written, folder / "elaborate.log", configuration.name)
    text = canonical(elaborated.read_text(encoding="utf-8"), root)
    elaborated.write_text(text, encoding="utf-8")
    tools.write_settings(written, {**settings, "kept_modules": [f"*{name}*" for name in children(text)]})
    tools.run_yosys(root / "synth" / "yosys" / "generic.tcl", written, folder / "generic.log", configuration.name)
    clock_gating.insert(folder / "generic.il", technology.slow)


def map_to_cells(configuration: Configuration, technology: Technology, folder: Path, effort: Effort) -> dict:
    """Maps generic.il to cells; returns the design with plain names of modules and cells."""
    library = technology.slow
    inverter_ff = next(iter(library.input_ff[library.inverter].values()))
    constraints = folder / "abc.constr"
    constraints.write_text(f"set_driving_cell {library.inverter}\nset_load {4 * inverter_ff:.3f} [all_outputs]\n", encoding="utf-8")
    settings = folder / "map_settings.tcl"
    tools.write_settings(settings, {
        "scripts": technology.root / "synth" / "yosys", "generic_netlist": folder / "generic.il", "liberty": library.path,
        "abc_constraints": constraints, "abc_period_ps": f"{1e6 / technology.target_mhz * effort.share:.0f}",
        "column_script": effort.column, "shared_script": effort.shared, "naming": "0", "tie_low": list(library.tie.get("0", ())),
        "tie_high": list(library.tie.get("1", ())), "netlist_json": folder / "mapped.json"})
    tools.run_yosys(technology.root / "synth" / "yosys" / "map.tcl", settings, folder / "map.log", configuration.name)
    design = json.loads((folder / "mapped.json").read_text(encoding="utf-8"))
    plain_modules(design)
    foreign = netlist.foreign_cells(design, library, set(ARRAYS))
    if foreign:
        raise FlowError(f"{configuration.name}: unmapped cells in the netlist: {', '.join(sorted(foreign))}")
    return design


def plain_modules(design: dict) -> None:
    """Gives derived modules their names in the RTL, with a number where one module has several sets of parameters."""
    called: dict[str, str] = {}
    for name, module in netlist.modules(design).items():
        if module["cells"] or plain_module(name) in ARRAYS:
            plain = plain_module(name)
            number = sum(re.fullmatch(rf"{plain}(__\d+)?", other) is not None for other in called.values())
            called[name] = f"{plain}__{number + 1}" if number else plain
    design["modules"] = {called.get(name, name): module for name, module in netlist.modules(design).items()}
    for module in netlist.modules(design).values():
        for cell in module["cells"].values():
            cell["type"] = called.get(cell["type"], cell["type"])


def array_cell(design: dict) -> str:
    """Name of the array's instance. FlowError unless there is one."""
    found = [name for name, cell in netlist.top(design)["cells"].items() if cell["type"] in ARRAYS]
    if len(found) != 1:
        raise FlowError(f"{TOP} has {len(found)} arrays")
    return found[0]


def connect_stand_in(design: dict, ports: Ports) -> list[tuple[str, bool]]:
    """Replaces the array by its stand-in, whose pins are single bits. Constant outputs become constants, and inputs that the array does not
    use are left open. Returns pins without times (the side band), and whether they are outputs. FlowError if the array in the subsystem has other
    ports than the array that was measured."""
    top = netlist.top(design)
    array = top["cells"].pop(array_cell(design))
    known = {port.name for port in ports.timed[MODES[0]]}
    cell: dict = {"hide_name": 0, "type": array_stand_in.CELL, "parameters": {}, "attributes": {}, "port_directions": {}, "connections": {}}
    constant: set[int] = set()
    others = []
    for port, bits in array["connections"].items():
        for index, bit in enumerate(bits):
            name = port if len(bits) == 1 else f"{port}[{index}]"
            is_output = array["port_directions"][port] == "output"
            if name in ports.unused:
                continue
            if name in ports.constant:
                constant.add(bit)
                continue
            if name not in known and port != array_stand_in.CLOCK:
                if not endpoints.SIDE_BAND.fullmatch(name):
                    raise FlowError(f"the array was measured without its port {name}")
                others.append((name, is_output))
            cell["port_directions"][array_stand_in.plain(name)] = "output" if is_output else "input"
            cell["connections"][array_stand_in.plain(name)] = [bit]
    if missing := known - {name for name in known if array_stand_in.plain(name) in cell["connections"]}:
        raise FlowError(f"the array in {TOP} lacks the port {min(missing)}")
    for other in top["cells"].values():
        other["connections"] = {pin: ["0" if bit in constant else bit for bit in bits] for pin, bits in other["connections"].items()}
    top["cells"][ARRAY] = cell
    return others


def _trees(design: dict, library: Library, ports: Ports) -> None:
    """Inserts the buffers that nets with much load need."""
    loads = {port.pin: port.load_ff for port in ports.timed[MODES[0]]}
    cell_load = floorplan.pin_load(library, 0.0)
    inside: dict[str, dict[str, float]] = {}
    for name, module in netlist.modules(design).items():
        if module["cells"] and module is not netlist.top(design):
            netlist.insert_fanout_trees(module, library, cell_load, netlist.clock_nets(module) | netlist.constant_nets(module, library))
            inside[name] = {port: max(values, default=0.0)
                            for port, values in netlist.port_loads(module, cell_load, library.wire_ff_per_sink).items()}

    def load(kind: str, pin: str) -> float:
        return loads.get(pin, 0.0) if kind == array_stand_in.CELL else inside[kind].get(pin, 0.0) if kind in inside else cell_load(kind, pin)

    top = netlist.top(design)
    clocks = netlist.clock_nets(top) | set(top["cells"][ARRAY]["connections"][array_stand_in.CLOCK])
    netlist.insert_fanout_trees(top, library, load, clocks | netlist.constant_nets(top, library))


@dataclass(frozen=True)
class _Timed:
    """The mapped subsystem with the array's stand-in, ready for OpenSTA."""

    configuration: Configuration
    technology: Technology
    folder: Path
    design: dict
    ports: dict[str, Ports]  # by corner
    others: list[tuple[str, bool]]

    def write(self) -> None:
        for corner, ports in self.ports.items():
            for mode in MODES:
                text = array_stand_in.liberty(ports.timed[mode], self.others, mode, self.technology.library(corner).voltage)
                (self.folder / f"array_{corner}_{mode}.lib").write_text(text, encoding="utf-8")
        (self.folder / "timing.v").write_text(verilog.write(self.design), encoding="utf-8")

    def files(self, corner: str, mode: str) -> timing.Netlist:
        library = self.technology.library(corner)
        return timing.Netlist(f"{self.configuration.name}, {TOP}, {corner} corner", self.folder / "timing.v", Path(),
                              [library.path, self.folder / f"array_{corner}_{mode}.lib"], library.wire_load, TOP)

    def _settings(self, files: timing.Netlist) -> dict[str, tools.Setting]:
        return {"liberty_files": files.liberty_files, "netlist": files.verilog, "top": TOP, "wire_load": files.wire_load,
                "period": f"{1e3 / self.technology.target_mhz:.6f}", "constraints": self.constraints,
                "margins": self.technology.root / "constraints" / "margins.sdc", "slew": f"{FO4_NS:.4f}", "load": f"{10 * CINV_FF:.4f}"}

    @property
    def constraints(self) -> Path:
        return self.technology.root / "constraints" / "subsystem" / "dtof_subsystem.sdc"

    def time(self, corner: str, mode: str, *steps: str, **settings: tools.Setting) -> timing.Report:
        """Runs steps of synth/sta/timing.tcl, as for the arrays."""
        return timing.measure(self.files(corner, mode), self.technology.root, self.technology.target_mhz,
                              self.folder / f"sta_{corner}_{'_'.join(steps)}.log", steps,
                              {"constraints": self.constraints, "wires": "", **settings})

    def slow_edges(self, corner: str) -> list[str]:
        """Pins whose transition is beyond the limit, with margins."""
        files = self.files(corner, "margins")
        settings = self.folder / f"edges_{corner}.tcl"
        tools.write_settings(settings, self._settings(files))
        return pins_of_slow_edges(tools.run_sta(self.technology.root / "synth" / "subsystem" / "edges.tcl", settings,
                                                self.folder / f"edges_{corner}.log", files.name))

    def sharpen_edges(self) -> None:
        """Cells that drive slow edges get more drive."""
        family = {kind: kinds for kinds in self.technology.slow.drives for kind in kinds}
        for _ in range(EDGE_ROUNDS):
            stronger = []
            for pin in self.slow_edges("slow"):
                kind, name, port = netlist.local_pin(self.design, pin)
                cell = (netlist.modules(self.design)[kind] if kind else netlist.top(self.design))["cells"][name]
                kinds = family.get(cell["type"], [cell["type"]])
                if cell["port_directions"].get(port) == "output" and cell["type"] != kinds[-1]:
                    stronger.append((kind or netlist.TOP, name, kinds[kinds.index(cell["type"]) + 1]))
            if not stronger:
                return
            netlist.resize(self.design, self.technology.slow, stronger)
            self.write()

    def overloaded(self) -> list[str]:
        library = self.technology.slow
        kinds = [name for name, module in netlist.modules(self.design).items() if module["cells"]]
        pin_load = floorplan.pin_load(library, 0.0)
        return [str(load) for kind in kinds if kind != TOP for load in loads.of_block(self.design, kind, library, pin_load) if load.is_too_much]

    def slacks(self, corner: str, mode: str) -> Slacks:
        if mode == "margins":
            return _slacks(self.time(corner, mode, "margins").margin())
        # The margins of a file without any: timing.tcl reports recovery and removal in that step alone.
        none = self.folder / "no_margins.sdc"
        none.write_text("", encoding="utf-8")
        return _slacks(self.time(corner, mode, "margins", margins=none).margin())

    def ends(self) -> tuple[Ends, dict[str, float]]:
        """Judges all ends in the slow corner, and returns the least setup slack with margins of the ends of each module, the array and the
        ports."""
        files = self.files("slow", "margins")
        report = self.time("slow", "nominal", "check")
        settings = self.folder / "ends.tcl"
        tools.write_settings(settings, {
            **self._settings(files),
            "asked": [pin for pins in report.unchecked.values() for pin in pins if not endpoints.SIDE_BAND.fullmatch(pin)]})
        output = tools.run_sta(self.technology.root / "synth" / "subsystem" / "ends.tcl", settings, self.folder / "ends.log", files.name)
        library, ports = self.technology.slow, self.ports["slow"]
        ends = judge_ends(files.name, count_ends(self.design, library, ports), report.unchecked, output, ports)
        kinds = {name: re.sub(r"__\d+$", "", cell["type"]) for name, cell in netlist.top(self.design)["cells"].items()
                 if cell["type"] not in library.area}
        worst: dict[str, float] = {}
        data, _ = timed_ends(output, "max")  # the resets have slacks of their own
        for end, slack in data.items():
            where = kinds.get(end.split("/")[0], TOP)
            worst[where] = min(slack, worst.get(where, math.inf))
        return ends, worst

    def resize(self, guard_ns: float) -> timing.Report:
        """Gates of late paths get more drive, in the slow corner with margins."""
        instances: dict[str, list[str]] = {}
        for name, cell in netlist.top(self.design)["cells"].items():
            if netlist.modules(self.design).get(cell["type"], {}).get("cells"):
                instances.setdefault(cell["type"], []).append(name)
        library = self.technology.slow
        report = self.time("slow", "margins", "resize", drives=library.drives, cell_areas=library.area, guard=f"{guard_ns}",
                           blocks=[item for kind, names in instances.items() for item in (kind, names, len(names))], stand_ins=[],
                           shrinkable=[], dispensable=[], buffer_pins=[library.buffers[0].input_pin, library.buffers[0].output_pin])
        netlist.resize(self.design, library, report.resized)
        self.write()
        return report

    def close_setup(self) -> Slacks:
        slacks, guard = self.slacks("slow", "margins"), run.RESIZE_GUARD_NS
        for _ in range(RESIZE_ROUNDS):
            if slacks.setup >= 0 or not self.resize(guard).resized:
                break
            slacks = self.slacks("slow", "margins")
            guard += max(-slacks.setup, 0.0)
        return slacks

    def fix_hold(self) -> None:
        """Buffers in front of ends where data are too early in the fast corner with margins."""
        for _ in range(HOLD_ROUNDS):
            early = self.time("fast", "margins", "margins", "early").early
            if not early:
                return
            buffers: dict[tuple[str, str, str], int] = {}
            for path in early:
                pin = netlist.local_pin(self.design, path.pins[-1])
                buffers[pin] = max(buffers.get(pin, 1), math.ceil(-path.slack / run.HOLD_BUFFER_NS))
            netlist.delay_pins(self.design, buffers, self.technology.slow)
            self.write()

    def parts(self) -> list[Part]:
        """Modules with their areas, the largest first. Sets of parameters of one module are one part."""
        library, top = self.technology.slow, netlist.top(self.design)
        numbers = Counter(cell["type"] for cell in top["cells"].values())
        found: dict[str, Part] = {TOP: Part(TOP, 1, netlist.count(top, library))}
        for name, module in netlist.modules(self.design).items():
            if module["cells"] and module is not top:
                plain = re.sub(r"__\d+$", "", name)
                own = Counts(*(value * numbers[name] for value in astuple(netlist.count(module, library))))
                before = found.get(plain, Part(plain, 0, Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)))
                found[plain] = Part(plain, before.instances + numbers[name],
                                    Counts(*(a + b for a, b in zip(astuple(before.counts), astuple(own)))))
        return sorted(found.values(), key=lambda part: -part.counts.area)


def _slacks(margin: Margin) -> Slacks:
    return Slacks(margin.slack, margin.hold_slack, margin.reset_slack, margin.start, margin.end)


def _attempt(result: Result, technology: Technology, ports: dict[str, Ports], folder: Path, number: int) -> tuple[_Timed, Slacks]:
    configuration = result.configuration
    design = map_to_cells(configuration, technology, folder, EFFORTS[number])
    others = connect_stand_in(design, ports["slow"])
    library = technology.slow
    _trees(design, library, ports["slow"])
    called = spef.plain_names(design)
    effort = folder / f"effort{number}"
    effort.mkdir(exist_ok=True)
    (effort / timing.NAMES).write_text(json.dumps({plain: name for before in called.values() for plain, name in before.items()}),
                                       encoding="utf-8")
    timed = _Timed(configuration, technology, effort, design, ports, others)
    timed.write()
    return timed, timed.close_setup()


def measure(result: Result, technology: Technology, runs: Path, folder: Path) -> Subsystem:
    """The subsystem around the array that run.run left in `runs`. FlowError at the first step that fails; a path that misses the clock is a
    figure and no error."""
    configuration = result.configuration
    ports = {corner: array_stand_in.measure(result, technology, runs, corner) for corner in CORNERS}
    generic(configuration, technology, folder)
    attempts = []
    for number in range(len(EFFORTS)):
        attempts.append(_attempt(result, technology, ports, folder, number))
        if attempts[-1][1].setup >= 0:
            break
    timed, _ = max(attempts, key=lambda attempt: min(attempt[1].setup, 0.0))
    timed.sharpen_edges()
    timed.fix_hold()
    timed.close_setup()
    ends, late = timed.ends()
    slacks = {(corner, mode): timed.slacks(corner, mode) for corner in CORNERS for mode in MODES}
    slow_edges = {corner: len(timed.slow_edges(corner)) for corner in CORNERS}
    parts, overloaded = timed.parts(), timed.overloaded()
    power = subsystem_power.measure(timed.design, configuration, ports["slow"], timed.others, technology, folder / "power", SEED)
    return Subsystem(configuration, parts, result.total_mm2, slacks, ends, late, slow_edges, overloaded, technology.target_mhz, power)


def measure_once(result: Result, technology: Technology, runs: Path, folder: Path, digest: str) -> Subsystem:
    """As `measure`, whose result is kept until an input changes. `digest`: of the report's inputs."""
    kept, key = folder / "result.pickle", (result.configuration.rtl_parameters(), digest)
    try:
        of, found = pickle.loads(kept.read_bytes())
        if of == key:
            return found
    except (OSError, pickle.UnpicklingError, EOFError, AttributeError, TypeError, ValueError, ImportError):
        pass
    found = measure(result, technology, runs, folder)
    kept.write_bytes(pickle.dumps((key, found)))
    return found


def measure_all(results: list[Result], technology: Technology, build: Path, workers: int, digest: str,
                progress: Callable[[str], None]) -> list[Subsystem]:
    """The subsystems around several arrays, whose runs are in `build`. The first failure stops all; what is finished is kept."""
    with ProcessPoolExecutor(workers) as pool:
        futures = {result.configuration.name: pool.submit(measure_once, result, technology, build / "runs" / result.configuration.name,
                                                          build / "subsystem" / result.configuration.name, digest) for result in results}
        found = []
        for name, future in futures.items():
            found.append(future.result())
            progress(f"[{len(found)}/{len(futures)}] {name}")
    return found
