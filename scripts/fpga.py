#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The demonstrator of fpga/ for an iCE40 HX8K, with either read-out: Yosys, nextpnr, icepack. Writes bitstreams and
netlists, which tests simulate, to build/fpga/ and, with --report, reports/fpga.md.

Fails if a memory did not become block RAM, if it does not fit, or if it is slower than the board's clock. What icetime, which
knows the chip from another database, says of the speed stands beside nextpnr's.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import fpga_check
from dtof_synth import program, statistics
from dtof_synth.errors import FlowError
from figures.small import written_root

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
BUILD = ROOT / "build" / "fpga"
REPORT = written_root(ROOT) / "reports" / "fpga.md"
TOP = "demonstrator"
FOLDER = ROOT / "fpga"
BOARD_MHZ = 12
SEED = 1  # of the placement: the same result in every run


@dataclass(frozen=True)
class Design:
    name: str  # of its files
    readout: str
    settings: dict[str, int]  # parameters that are not the top's own, as in tb_cpp/tests/demonstrator/CMakeLists.txt

    @property
    def parameters(self) -> dict[str, int]:
        return parameters() | self.settings

    def file(self, ending: str) -> Path:
        return BUILD / f"{self.name}{ending}"


DESIGNS = (
    Design("demonstrator", "hisPointer", {}),
    Design("demonstrator_pool", "poolPointer lean", {"READOUT": 64, "COLUMNS": 2}),
)

@dataclass(frozen=True)
class Use:
    used: int
    available: int


@dataclass(frozen=True)
class Result:
    cells: Use  # a look-up table of four inputs, its carry and a flip-flop
    block_rams: Use
    nextpnr_mhz: float
    icetime_mhz: float


@dataclass(frozen=True)
class Outcome:
    design: Design
    found: Result
    cells: dict[str, int]
    memories: int
    test: str  # what the test of the netlist says


def sources() -> list[str]:
    """Files for Yosys, relative to hdl/: all RTL with the FPGA's memories, and the demonstrator."""
    files = [str(Path(file).relative_to(HDL)) if Path(file).is_absolute() else file
             for file in fpga_check.source_files(HDL / "technology/fpga")]  # fmt: skip
    return [*files, *sorted(f"../{file.relative_to(ROOT)}" for file in FOLDER.glob("*.sv"))]


def parameters() -> dict[str, int]:
    """Parameters of the top with their default values."""
    text = (FOLDER / f"{TOP}.sv").read_text(encoding="utf-8")
    return {name: int(value) for name, value in re.findall(r"^ +parameter int (\w+) = (\d+),?$", text, re.MULTILINE)}


def run(command: list[str], log: str, folder: Path = BUILD) -> str:
    """Runs a command; returns its output and stores it in build/fpga/."""
    result = subprocess.run(command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    (BUILD / log).write_text(result.stdout, encoding="utf-8")
    if result.returncode != 0:
        errors = [line for line in result.stdout.splitlines() if "ERROR" in line]
        raise FlowError(f"{command[0]}: {errors[-1] if errors else 'failed'} (build/fpga/{log})")
    return result.stdout


def synthesise(design: Design) -> dict[str, int]:
    """Number of cells by type. Writes the netlist for nextpnr and for simulation, and models of its cells."""
    settings = " ".join(f"-set {name} {value}" for name, value in design.settings.items())
    # Yosys looks into the modules with their defaults, too, where the FPGA's clock gate would stop it.
    script = (f"read_verilog -sv -DSYNTHESIS -Icommon {' '.join(sources())}; chparam -set CLOCK_WAITS 0 dtof_subsystem; "
              f"chparam {settings} {TOP}; synth_ice40 -top {TOP} "
              f"-json {design.file('.json')}; rename -top {TOP}; write_verilog -noattr {design.file('_netlist.v')}; tee -o /dev/stdout stat")  # fmt: skip
    text = run(["yosys", "-Q", "-T", "-p", script], f"{design.name}_yosys.log", HDL)
    share = Path(shutil.which("yosys") or "").resolve().parents[1] / "share/yosys"
    models = (share / "ice40/cells_sim.v").read_text(encoding="utf-8")
    (BUILD / "ice40_cells.v").write_text("`define NO_ICE40_DEFAULT_ASSIGNMENTS\n" + models, encoding="utf-8")
    return statistics.cells(text)


def memories(design: Design) -> int:
    """Number of memories in the top: the behavioural memories report themselves at the start of a simulation."""
    program = design.file(".vvp")
    settings = [f"-P{TOP}.{name}={value}" for name, value in design.settings.items()]
    files = [file.replace("technology/fpga/", "technology/behavioural/") for file in sources()]
    run(["iverilog", "-g2012", "-s", TOP, "-o", str(program), *settings, "-Icommon", *files],
        f"{design.name}_iverilog.log", HDL)
    text = run(["vvp", "-n", str(program), "+sram_report"], f"{design.name}_memories.log")
    return len(re.findall(r"\d+ words x \d+ bits", text))


def place_and_route(design: Design) -> Result:
    name = design.name
    run(["nextpnr-ice40", "--hx8k", "--package", "ct256", "--pcf", str(FOLDER / "ice40_hx8k.pcf"), "--json", f"{name}.json",
         "--asc", f"{name}.asc", "--freq", str(BOARD_MHZ), "--seed", str(SEED), "--report", f"{name}_report.json"],
        f"{name}_nextpnr.log")
    run(["icepack", f"{name}.asc", f"{name}.bin"], f"{name}_icepack.log")
    return result(json.loads(design.file("_report.json").read_text(encoding="utf-8")),
                  run(["icetime", "-d", "hx8k", "-mt", f"{name}.asc"], f"{name}_icetime.log"))


def result(report: dict, icetime: str) -> Result:
    """Reads nextpnr's report and icetime's text."""
    use = {name: Use(entry["used"], entry["available"]) for name, entry in report["utilization"].items()}
    clocks = [clock["achieved"] for clock in report["fmax"].values()]
    other = re.search(r"\(([\d.]+) MHz\)", icetime)
    if len(clocks) != 1 or not other:
        raise FlowError("nextpnr or icetime does not say how fast the one clock is")
    return Result(use["ICESTORM_LC"], use["ICESTORM_RAM"], clocks[0], float(other.group(1)))


def problems(found: Result, cells: dict[str, int], expected_memories: int) -> list[str]:
    block_rams = sum(number for kind, number in cells.items() if kind.startswith("SB_RAM40"))
    sentences = [] if expected_memories else ["the simulation names no memories"]
    if block_rams < expected_memories:
        sentences.append(f"{block_rams} block RAMs for {expected_memories} memories")
    if min(found.nextpnr_mhz, found.icetime_mhz) < BOARD_MHZ:
        sentences.append(f"slower than the board's {BOARD_MHZ} MHz")
    return sentences


def row(title: str, values: list[str]) -> str:
    return f"| {title} | {' | '.join(values)} |"


def report(outcomes: list[Outcome]) -> str:
    share = lambda use: f"{use.used:,} of {use.available:,} ({100 * use.used / use.available:.0f} %)"  # noqa: E731
    designs = [outcome.design for outcome in outcomes]
    found = [outcome.found for outcome in outcomes]
    rates = [f"{BOARD_MHZ * 1000 // design.parameters['CLOCKS_PER_BIT']:,} kbit/s" for design in designs]
    registers = [sum(number for kind, number in outcome.cells.items() if kind.startswith("SB_DFF")) for outcome in outcomes]
    return "\n".join([
        "# FPGA demonstrator",
        "",
        f"From `make fpga`: [the demonstrator](../fpga/{TOP}.sv) on an iCE40 HX8K. It makes photons on the chip and sends the results over a",
        "serial line. Mapped by Yosys, placed and routed by nextpnr-ice40, packed by icepack.",
        "",
        row("", [design.readout for design in designs]),
        "|---|" + "---:|" * len(outcomes),
        row("columns x pixels of a column", [f"{design.parameters['COLUMNS']} x {design.parameters['ROWS']}" for design in designs]),
        row("logic cells", [share(each.cells) for each in found]),
        row("of them look-up tables of four inputs", [f"{outcome.cells['SB_LUT4']:,}" for outcome in outcomes]),
        row("flip-flops", [f"{number:,}" for number in registers]),
        row("memories", [str(outcome.memories) for outcome in outcomes]),
        row("block RAMs", [share(each.block_rams) for each in found]),
        row("highest clock by nextpnr", [f"{each.nextpnr_mhz:.1f} MHz" for each in found]),
        row("by icetime", [f"{each.icetime_mhz:.1f} MHz" for each in found]),
        row("the board's clock", [f"{BOARD_MHZ} MHz"] * len(outcomes)),
        row("serial line at that clock", rates),
        row("bitstream", [f"{design.file('.bin').stat().st_size:,} bytes" for design in designs]),
        "",
        "The netlists after mapping were simulated with Yosys's models of the cells:",
        "",
        *(f"* {outcome.design.readout}: {outcome.test}" for outcome in outcomes),
        "",
    ])  # fmt: skip


def passed(design: Design, program: Path) -> str:
    """Names of the netlist's tests, which all passed; FlowError if a test failed or none ran."""
    text = run([str(program)], f"{design.name}_netlist_test.log")
    found = re.search(r"\[  PASSED  \] (\d+) tests", text)
    names = re.findall(r"\[       OK \] \w+\.(\w+)", text)
    if not found or int(found.group(1)) != len(names) or not names:
        raise FlowError("the test of the netlist ran no tests")
    return "passed " + ", ".join(f"`{name}`" for name in names)


def kept_outcome(design: Design, tests: Path) -> Outcome:
    """Outcome of the last run for this design, after a test of its netlist."""
    kept = json.loads(design.file("_result.json").read_text(encoding="utf-8"))
    found = result(json.loads(design.file("_report.json").read_text(encoding="utf-8")),
                   design.file("_icetime.log").read_text(encoding="utf-8"))  # fmt: skip
    test = passed(design, (tests / f"{design.name}_netlist_test").resolve())
    return Outcome(design, found, kept["cells"], kept["memories"], test)


def make(design: Design) -> list[str]:
    """Makes the bitstream from RTL; returns the faults found."""
    kept = design.file("_result.json")
    kept.unlink(missing_ok=True)
    cells, expected = synthesise(design), memories(design)
    found = place_and_route(design)
    sentences = [f"{design.readout}: {sentence}" for sentence in problems(found, cells, expected)]
    if not sentences:
        kept.write_text(json.dumps({"cells": cells, "memories": expected}), encoding="utf-8")
        print(f"fpga: {design.readout}: {found.cells.used} of {found.cells.available} logic cells, {found.block_rams.used} of "
              f"{found.block_rams.available} block RAMs, {found.nextpnr_mhz:.1f} MHz; wrote build/fpga/{design.name}.bin")
    return sentences


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--report", type=Path, metavar="FOLDER", help="run the tests of the netlists, which are in this folder, "
                        "and write the report")  # fmt: skip
    arguments = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    if arguments.report:
        REPORT.write_text(report([kept_outcome(design, arguments.report) for design in DESIGNS]), encoding="utf-8")
        print(f"fpga: the netlists' depths are the models'; wrote {REPORT.relative_to(ROOT)}")
        return 0
    sentences = [sentence for design in DESIGNS for sentence in make(design)]
    for sentence in sentences:
        print(f"error: {sentence}", file=sys.stderr)
    return 1 if sentences else 0


if __name__ == "__main__":
    try:
        program.run(main)
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
