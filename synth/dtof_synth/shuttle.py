# SPDX-License-Identifier: Apache-2.0
"""The chips of shuttle/ for a shared run of IHP's open 130 nm process (make shuttle): netlists, timing in three corners, and inputs for
LibreLane and OpenROAD-flow-scripts in build/shuttle/; with --report, reports/shuttle.md.

The PDK's Liberty files are found by name below --pdk. Memories are flip-flops, so no SRAM macro is needed. The step from RTL to a netlist
takes its files and parameters from the written inputs of LibreLane, so that these are complete. Layout and pad ring are not made here.
"""

from __future__ import annotations

import argparse
import gzip
import json
import re
import subprocess
import sys
from dataclasses import asdict, dataclass, field
from pathlib import Path

from . import cell_models, liberty, library, mapping, netlist, tools, verilog
from .errors import FlowError
from .floorplan import pin_load
from .library import Library
from .report_inputs import ROOT

from figures.small import written_root

FOLDER = ROOT / "shuttle"
TECHNOLOGY = ROOT / "hdl" / "technology" / "ihp130"
BUILD = ROOT / "build" / "shuttle"
REPORT = written_root(ROOT) / "reports" / "shuttle.md"
PDK = ROOT.parent / "shared" / "pdk" / "ihp130"
TOP = "dtof_shuttle"
CLOCK_GATE = "sg13g2_lgcp_1"
CLOCK_PINS = ("CLK", "GCLK")
CORNERS = {"slow": "slow_1p08V_125C", "typical": "typ_1p20V_25C", "fast": "fast_1p32V_m40C"}
PLATFORM = "ihp-sg13g2"
CORE_MODULES = ("demonstrator_core", "photon_generator", "register_writer", "target_command", "uart_receiver", "uart_transmitter", "word_sender")
SYNTHESIS_SHARE = 0.8  # of the period, for ABC: the rest is for clock-to-data, setup and fan-out trees
UTILISATION = 60  # of the core, %


@dataclass(frozen=True)
class Chip:
    name: str  # of its folder
    readout: str
    parameters: dict[str, int] = field(hash=False)  # of dtof_shuttle, as in tb_cpp/tests/demonstrator/CMakeLists.txt

    @property
    def folder(self) -> Path:
        return BUILD / self.name


CHIPS = (Chip("ezpointer", "ezPointer", {"READOUT": 0, "COLUMNS": 16, "ROWS": 16}),
         Chip("poolpointer_lean", "poolPointer lean", {"READOUT": 64, "COLUMNS": 4, "ROWS": 16}))


@dataclass(frozen=True)
class Corner:
    """Slacks in ns at the period of the constraints."""

    setup: float
    inside: float  # setup, of paths between flip-flops: the budgets of the ports follow the period
    hold: float
    recovery: float
    removal: float
    unconstrained: int  # ends of paths that nothing reaches: flip-flops with a constant input


@dataclass(frozen=True)
class Result:
    cells: int
    flip_flops: int
    area_mm2: float
    core_mm2: float  # at the utilisation of the written inputs
    period: float
    corners: dict[str, Corner]


# ---- PDK --------------------------------------------------------------------------------------------------

def liberties(pdk: Path, folder: Path) -> dict[str, Path]:
    """Liberty of each corner, uncompressed in `folder`. FlowError names what is missing."""
    found = {}
    for corner, suffix in CORNERS.items():
        name = f"sg13g2_stdcell_{suffix}.lib"
        files = sorted(path for path in pdk.rglob(f"{name}*") if path.name in (name, f"{name}.gz"))
        if not files:
            raise FlowError(f"{pdk}: {name} is not here; PDK=<folder> names IHP's open PDK")
        data = files[0].read_bytes()
        found[corner] = folder / name
        found[corner].write_bytes(gzip.decompress(data) if files[0].suffix == ".gz" else data)
    return found


# ---- Inputs of layout flows ---------------------------------------------------------------------------------

def sources() -> list[Path]:
    """RTL of a chip, modules after the modules that they contain."""
    return [*sorted(TECHNOLOGY.glob("*.sv"), key=lambda path: path.name), *mapping.rtl_files(ROOT),
            *(ROOT / "fpga" / f"{name}.sv" for name in reversed(CORE_MODULES)), FOLDER / f"{TOP}.sv"]


def _packages_first(files: list[Path]) -> list[Path]:
    return sorted(files, key=lambda path: not path.name.endswith("_pkg.sv"))


def period(text: str) -> float:
    """Clock period of the constraints, ns."""
    found = re.search(r"^set period ([\d.]+)$", text, re.MULTILINE)
    if not found:
        raise FlowError(f"shuttle/{TOP}.sdc: no line 'set period <ns>'")
    return float(found.group(1))


def librelane(chip: Chip, clock_ns: float) -> dict:
    """Configuration of LibreLane, whose paths begin in the chip's folder, three levels below the project."""
    return {
        "meta": {"version": 2, "flow": "Classic"},
        "DESIGN_NAME": TOP,
        "VERILOG_FILES": [f"dir::../../../{file.relative_to(ROOT)}" for file in _packages_first(sources())],
        "VERILOG_INCLUDE_DIRS": ["dir::../../../hdl/common"],
        "VERILOG_DEFINES": ["SYNTHESIS"],
        "SYNTH_PARAMETERS": [f"{name}={value}" for name, value in chip.parameters.items()],
        "CLOCK_PORT": "clk_i",
        "CLOCK_PERIOD": clock_ns,
        "PNR_SDC_FILE": f"dir::../../../shuttle/{TOP}.sdc",
        "SIGNOFF_SDC_FILE": f"dir::../../../shuttle/{TOP}.sdc",
        "FP_CORE_UTIL": UTILISATION,
    }


def orfs(chip: Chip, memory_bits: int) -> str:
    """config.mk of OpenROAD-flow-scripts."""
    files = " \\\n".join(f"  $(PROJECT)/{file.relative_to(ROOT)}" for file in _packages_first(sources()))
    return "".join([
        f"# Generated by `make shuttle`: {TOP} with {chip.readout}. make DESIGN_CONFIG=<this file> in OpenROAD-flow-scripts/flow.\n",
        "PROJECT := $(abspath $(dir $(DESIGN_CONFIG))/../../..)\n",
        f"export PLATFORM = {PLATFORM}\nexport DESIGN_NAME = {TOP}\nexport DESIGN_NICKNAME = {TOP}_{chip.name}\n",
        f"export VERILOG_FILES = \\\n{files}\n",
        "export VERILOG_INCLUDE_DIRS = $(PROJECT)/hdl/common\nexport VERILOG_DEFINES = -DSYNTHESIS\n",
        f"export VERILOG_TOP_PARAMS = {' '.join(f'{name} {value}' for name, value in chip.parameters.items())}\n",
        f"export SDC_FILE = $(PROJECT)/shuttle/{TOP}.sdc\n",
        "# Memories are flip-flops; this is the largest.\n",
        f"export SYNTH_MEMORY_MAX_BITS = {memory_bits}\n",
        f"export CORE_UTILIZATION = {UTILISATION}\n"])


def expanded(config: Path) -> dict[str, str]:
    """Variables of a config.mk as make expands them. FlowError if make refuses the file."""
    wanted = ("VERILOG_FILES", "VERILOG_INCLUDE_DIRS", "VERILOG_TOP_PARAMS", "SDC_FILE")
    text = f"DESIGN_CONFIG := {config}\ninclude {config}\nall:\n" + "".join(f"\t@echo '{name}=$(strip $({name}))'\n" for name in wanted)
    try:
        found = subprocess.run(["make", "-s", "-f", "-"], input=text, text=True, capture_output=True, check=True).stdout
    except subprocess.CalledProcessError as error:
        raise FlowError(f"{config}: make: {error.stderr.strip()}") from None
    return dict(line.split("=", 1) for line in found.splitlines())


def write_inputs(chip: Chip, clock_ns: float) -> None:
    chip.folder.mkdir(parents=True, exist_ok=True)
    (chip.folder / "librelane.json").write_text(json.dumps(librelane(chip, clock_ns), indent=2) + "\n", encoding="utf-8")
    (chip.folder / "config.mk").write_text(orfs(chip, memory_bits(chip)), encoding="utf-8")


def memory_bits(chip: Chip) -> int:
    """Bits of the largest memory: the memories of technology/behavioural report themselves at the start of a simulation."""
    program = chip.folder / "memories.vvp"
    files = [Path(str(file).replace("technology/ihp130", "technology/behavioural")) for file in _packages_first(sources())]
    settings = [f"-P{TOP}.{name}={value}" for name, value in chip.parameters.items()]
    command = ["iverilog", "-g2012", "-s", TOP, "-o", str(program), *settings, f"-I{ROOT}/hdl/common", *map(str, files)]
    for step in (command, ["vvp", "-n", str(program), "+sram_report"]):
        done = subprocess.run(step, text=True, capture_output=True, check=False)
        if done.returncode != 0:
            raise FlowError(f"{chip.name}: {step[0]}: {(done.stderr or done.stdout).strip().splitlines()[0]}")
    found = [int(words) * int(bits) for words, bits in re.findall(r"(\d+) words x (\d+) bits", done.stdout)]
    if not found:
        raise FlowError(f"{chip.name}: the simulation names no memories")
    return max(found)


# ---- Netlist ------------------------------------------------------------------------------------------------

def _own_files(config: dict, folder: Path) -> list[Path]:
    files = [(folder / name.removeprefix("dir::")).resolve() for name in config["VERILOG_FILES"]]
    if missing := [file for file in files if not file.is_file()]:
        raise FlowError(f"{missing[0]}: in the inputs of LibreLane, and not here")
    return files


def check_orfs(config: Path, files: list[Path]) -> None:
    """FlowError unless both layout flows read the same files, which exist."""
    found = expanded(config)
    if [Path(name).resolve() for name in found["VERILOG_FILES"].split()] != files:
        raise FlowError(f"{config}: the files differ from those of LibreLane")
    for name in ("SDC_FILE", "VERILOG_INCLUDE_DIRS"):
        if not Path(found[name]).exists():
            raise FlowError(f"{config}: {name}: {found[name]} is not here")


def clock_nets(module: netlist.Module) -> set[int]:
    """Nets of the clock port and of the outputs of clock gates."""
    return netlist.port_clock_nets(module) | {cell["connections"]["GCLK"][0] for cell in module["cells"].values() if cell["type"] == CLOCK_GATE}


def synthesise(chip: Chip, cells: Library, clock_ns: float) -> dict:
    """The netlist with fan-out trees, from the files and parameters in the inputs of LibreLane."""
    config = json.loads((chip.folder / "librelane.json").read_text(encoding="utf-8"))
    files = _own_files(config, chip.folder)
    check_orfs(chip.folder / "config.mk", files)
    inverter_ff = next(iter(cells.input_ff[cells.inverter].values()))
    constraints = chip.folder / "abc.constr"
    constraints.write_text(f"set_driving_cell {cells.inverter}\nset_load {4 * inverter_ff:.3f} [all_outputs]\n", encoding="utf-8")
    settings = chip.folder / "settings.tcl"
    tools.write_settings(settings, {
        "top": config["DESIGN_NAME"], "rtl_files": files, "rtl_include": chip.folder / config["VERILOG_INCLUDE_DIRS"][0].removeprefix("dir::"),
        "parameters": dict(entry.split("=") for entry in config["SYNTH_PARAMETERS"]), "liberty": cells.path, "abc_constraints": constraints,
        "abc_period_ps": f"{1e3 * SYNTHESIS_SHARE * clock_ns:.0f}", "tie_low": list(cells.tie["0"]), "tie_high": list(cells.tie["1"]),
        "netlist_json": chip.folder / "mapped.json"})
    tools.run_yosys(FOLDER / "synthesis.tcl", settings, chip.folder / "yosys.log", chip.name)
    design = json.loads((chip.folder / "mapped.json").read_text(encoding="utf-8"))
    module = netlist.top(design)
    if foreign := netlist.foreign_cells({"modules": {TOP: module}}, cells, set()):
        raise FlowError(f"{chip.name}: unmapped cells in the netlist: {', '.join(sorted(foreign))}")
    module["cells"] = {re.sub(r"\W", "_", name).strip("_"): cell for name, cell in module["cells"].items()}
    design = {"modules": {TOP: module}}
    netlist.insert_fanout_trees(module, cells, pin_load(cells, 0.0), clock_nets(module) | netlist.constant_nets(module, cells))
    return design


# ---- Timing -------------------------------------------------------------------------------------------------

_PARTS = re.compile(r"^DTOF_(CHECK|RECOVERY|REMOVAL|TRANSITION)\n(.*?)^DTOF_", re.MULTILINE | re.DOTALL)


def corner(output: str) -> Corner:
    """Reads what timing.tcl printed. FlowError for a fault that check_setup or a transition shows. Clock pins are left out of the
    transitions, because the clock tree is not built yet."""
    slack = re.search(r"^DTOF_SLACK (\S+) (\S+)$", output, re.MULTILINE)
    inside = re.search(r"^DTOF_INSIDE (\S+)$", output, re.MULTILINE)
    parts = dict(_PARTS.findall(output.replace("DTOF_REMOVAL\n", "DTOF_\nDTOF_REMOVAL\n").replace("DTOF_TRANSITION\n", "DTOF_\nDTOF_TRANSITION\n")))
    if not slack or not inside or parts.keys() != {"CHECK", "RECOVERY", "REMOVAL", "TRANSITION"}:
        raise FlowError("OpenSTA printed no slacks")
    slow = [pin for pin in re.findall(r"^(\S+) .*\(VIOLATED\)$", parts["TRANSITION"], re.MULTILINE) if pin.rsplit("/", 1)[-1] not in CLOCK_PINS]
    if slow:
        raise FlowError(f"{slow[0]}: the transition is slower than the constraints allow")
    ends = 0
    for warning in re.findall(r"^Warning: (.*)$", parts["CHECK"], re.MULTILINE):
        found = re.search(r"(\d+) unconstrained endpoint", warning)
        if not found:
            raise FlowError(f"OpenSTA: {warning}")
        ends = int(found.group(1))
    return Corner(float(slack.group(1)), float(inside.group(1)), float(slack.group(2)), _worst(parts["RECOVERY"]), _worst(parts["REMOVAL"]), ends)


def _worst(table: str) -> float:
    found = re.findall(r"^\S+ +(-?[\d.]+)(?: \(VIOLATED\))?$", table, re.MULTILINE)
    if not found:
        raise FlowError("OpenSTA printed no check of the reset")
    return min(map(float, found))


def constant_ends(module: netlist.Module, cells: Library) -> int:
    """Number of data inputs of flip-flops that a tie cell drives."""
    constants = netlist.constant_nets(module, cells)
    return sum(cell["connections"]["D"][0] in constants for cell in module["cells"].values() if cell["type"] in cells.sequential)


def time(chip: Chip, libraries: dict[str, Path]) -> dict[str, Corner]:
    """Timing of the written netlist in each corner."""
    found = {}
    for name, path in libraries.items():
        settings = chip.folder / f"timing_{name}_settings.tcl"
        tools.write_settings(settings, {"liberty": path, "netlist": chip.folder / "netlist.v", "top": TOP,
                                        "constraints": FOLDER / f"{TOP}.sdc"})
        output = tools.run_sta(FOLDER / "timing.tcl", settings, chip.folder / f"timing_{name}.log", f"{chip.name}, {name} corner")
        found[name] = corner(output)
    return found


# ---- Runs and report ----------------------------------------------------------------------------------------

def make(chip: Chip, libraries: dict[str, Path]) -> Result:
    """From RTL to the timed netlist; writes the result beside it. FlowError for an end of a path that is neither timed nor constant."""
    (chip.folder / "result.json").unlink(missing_ok=True)
    clock_ns = period((FOLDER / f"{TOP}.sdc").read_text(encoding="utf-8"))
    write_inputs(chip, clock_ns)
    cells = library.read(libraries["slow"])
    design = synthesise(chip, cells, clock_ns)
    module = netlist.modules(design)[TOP]
    (chip.folder / "netlist.v").write_text(verilog.write(design), encoding="utf-8")
    kinds = {cell["type"] for cell in module["cells"].values()}
    (chip.folder / "cells.v").write_text(cell_models.verilog(liberty.read(libraries["typical"]), kinds), encoding="utf-8")
    corners = time(chip, libraries)
    constants = constant_ends(module, cells)
    for name, found in corners.items():
        if found.unconstrained != constants:
            raise FlowError(f"{chip.name}, {name} corner: {found.unconstrained} ends are not timed, and {constants} flip-flops have a constant input")
    counts = netlist.count(module, cells)
    result = Result(counts.cells, counts.flip_flops, counts.area / 1e6, counts.area / 1e4 / UTILISATION, clock_ns, corners)
    (chip.folder / "result.json").write_text(json.dumps(asdict(result)), encoding="utf-8")
    return result


def kept(chip: Chip) -> Result:
    """Result of the last run."""
    try:
        found = json.loads((chip.folder / "result.json").read_text(encoding="utf-8"))
    except OSError:
        raise FlowError(f"build/shuttle/{chip.name}: `make shuttle` makes it first") from None
    return Result(**(found | {"corners": {name: Corner(**values) for name, values in found["corners"].items()}}))


def faults(result: Result) -> list[str]:
    """Negative slacks."""
    return [f"{name} corner: {kind} slack {value:.3f} ns" for name, found in result.corners.items()
            for kind, value in (("setup", found.setup), ("hold", found.hold), ("recovery", found.recovery), ("removal", found.removal)) if value < 0]


def passed(chip: Chip, program: Path) -> str:
    """Names of the netlist's tests, which all passed; FlowError if a test failed or none ran."""
    done = subprocess.run([str(program)], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    (chip.folder / "test.log").write_text(done.stdout, encoding="utf-8")
    names = re.findall(r"^\[       OK \] \w+\.(\w+)", done.stdout, re.MULTILINE)
    if done.returncode != 0 or not names or "[  PASSED  ]" not in done.stdout:
        raise FlowError(f"{chip.name}: the test of the netlist fails (build/shuttle/{chip.name}/test.log)")
    return ", ".join(f"`{name}`" for name in names)


def _row(title: str, values: list[str]) -> str:
    return f"| {title} | {' | '.join(values)} |"


def report(results: dict[Chip, Result], tests: dict[Chip, str]) -> str:
    found = list(results.values())
    corner_rows = [_row(f"{kind} slack, {name}, ns", [f"{getattr(result.corners[name], kind):.2f}" for result in found])
                   for kind in ("setup", "hold", "recovery", "removal") for name in CORNERS]
    fastest = [f"{1e3 / (result.period - result.corners['slow'].inside):.0f}" for result in found]
    return "\n".join([
        "# Chips in open silicon",
        "",
        f"From `make shuttle`: [{TOP}](../shuttle/{TOP}.sv) in cells of IHP SG13G2 (130 nm), for a shared run. The chip makes photons and sends",
        "the results over a serial line. Memories are flip-flops. The netlists have no layout: there is no clock tree, and wires have no load.",
        "",
        _row("", [chip.readout for chip in results]),
        "|---|" + "---:|" * len(found),
        _row("columns x pixels of a column", [f"{chip.parameters['COLUMNS']} x {chip.parameters['ROWS']}" for chip in results]),
        _row("cells", [f"{result.cells:,}" for result in found]),
        _row("of them flip-flops", [f"{result.flip_flops:,}" for result in found]),
        _row("area of cells, mm2", [f"{result.area_mm2:.2f}" for result in found]),
        _row(f"core at {UTILISATION} % utilisation, mm2", [f"{result.core_mm2:.2f}" for result in found]),
        _row("clock, MHz", [f"{1e3 / result.period:.0f}" for result in found]),
        _row("highest clock in the slow corner, MHz", fastest),
        *corner_rows,
        _row("ends of paths that are not timed", [f"{result.corners['slow'].unconstrained} flip-flops with a constant input" for result in found]),
        "",
        "Corners: slow 1.08 V, 125 C; typical 1.20 V, 25 C; fast 1.32 V, -40 C. The slacks include an uncertainty of the clock's edges: 0.25 ns for",
        "setup, 0.10 ns for hold.",
        "",
        "The netlists were simulated with models of the cells that are generated from the PDK's Liberty:",
        "",
        *(f"* {chip.readout}: passed {tests[chip]}" for chip in results),
        "",
        "Inputs for LibreLane (`librelane.json`) and OpenROAD-flow-scripts (`config.mk`) are in `build/shuttle/`. The netlists above come from the",
        "files, parameters and constraints that these inputs name. The two layout flows were not run.",
        ""])


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--pdk", type=Path, default=PDK, help="folder with the Liberty files of IHP's open PDK")
    parser.add_argument("--report", type=Path, metavar="FOLDER", help="run the tests of the netlists, which are in this folder, and write the report")
    arguments = parser.parse_args()
    try:
        if arguments.report:
            results = {chip: kept(chip) for chip in CHIPS}
            tests = {chip: passed(chip, (arguments.report / f"shuttle_{chip.name}_netlist_test").resolve()) for chip in CHIPS}
            REPORT.write_text(report(results, tests), encoding="utf-8")
            print(f"shuttle: the netlists' depths are the models'; wrote {REPORT.relative_to(ROOT)}")
            return 0
        BUILD.mkdir(parents=True, exist_ok=True)
        libraries = liberties(arguments.pdk, BUILD)
        wrong: list[str] = []
        for chip in CHIPS:
            result = make(chip, libraries)
            print(f"shuttle: {chip.readout}: {result.area_mm2:.2f} mm2 of cells, {result.corners['slow'].setup:.2f} ns of slack in the slow corner; "
                  f"wrote build/shuttle/{chip.name}/")
            wrong += [f"{chip.readout}: {fault}" for fault in faults(result)]
        for fault in wrong:
            print(f"error: {fault}", file=sys.stderr)
        return 1 if wrong else 0
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
