#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The demonstrator of hdl/demonstrator for an iCE40 HX8K: Yosys, nextpnr, icepack. Writes build/fpga/demonstrator.bin, the
netlist that demonstrator_netlist_test simulates, and, with --report, reports/fpga.md.

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

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
BUILD = ROOT / "build" / "fpga"
REPORT = ROOT / "reports" / "fpga.md"
TOP = "demonstrator"
FOLDER = HDL / "demonstrator"
BOARD_MHZ = 12
SEED = 1  # of the placement: the same result in every run

from dtof_synth.errors import FlowError  # noqa: E402, fpga_check has set the path


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


def sources() -> list[str]:
    """For Yosys, from hdl/: the list of all RTL with the FPGA's memories, and the demonstrator."""
    files = [str(Path(file).relative_to(HDL)) if Path(file).is_absolute() else file
             for file in fpga_check.source_files(HDL / "technology/fpga")]  # fmt: skip
    return [*files, *sorted(str(file.relative_to(HDL)) for file in FOLDER.glob("*.sv"))]


def parameters() -> dict[str, int]:
    """The top's parameters, as it declares them."""
    text = (FOLDER / f"{TOP}.sv").read_text(encoding="utf-8")
    return {name: int(value) for name, value in re.findall(r"^ +parameter int (\w+) = (\d+),?$", text, re.MULTILINE)}


def run(command: list[str], log: str, folder: Path = BUILD) -> str:
    """What the command prints, which is kept in build/fpga/, too."""
    result = subprocess.run(command, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    (BUILD / log).write_text(result.stdout, encoding="utf-8")
    if result.returncode != 0:
        errors = [line for line in result.stdout.splitlines() if "ERROR" in line]
        raise FlowError(f"{command[0]}: {errors[-1] if errors else 'failed'} (build/fpga/{log})")
    return result.stdout


def synthesise() -> dict[str, int]:
    """Cells by type. Writes the netlist for nextpnr and for simulation, and the cells' models beside it."""
    script = (f"read_verilog -sv -DSYNTHESIS -Ipackage {' '.join(sources())}; synth_ice40 -top {TOP} "
              f"-json {BUILD}/{TOP}.json; write_verilog -noattr {BUILD}/{TOP}_netlist.v; tee -o /dev/stdout stat")  # fmt: skip
    text = run(["yosys", "-Q", "-T", "-p", script], "yosys.log", HDL)
    share = Path(shutil.which("yosys") or "").resolve().parents[1] / "share/yosys"
    models = (share / "ice40/cells_sim.v").read_text(encoding="utf-8")
    (BUILD / "ice40_cells.v").write_text("`define NO_ICE40_DEFAULT_ASSIGNMENTS\n" + models, encoding="utf-8")
    statistics = text[text.rfind("Number of cells:"):]
    return {kind: int(number) for kind, number in re.findall(r"^ +(\w+) +(\d+)$", statistics, re.MULTILINE)}


def memories() -> int:
    """Memories of the top, as the behavioural ones say of themselves at the start of a simulation."""
    program = BUILD / "memories.vvp"
    files = [file.replace("/fpga/", "/behavioural/") for file in sources()]
    run(["iverilog", "-g2012", "-s", TOP, "-o", str(program), "-Ipackage", *files], "iverilog.log", HDL)
    return len(re.findall(r"\d+ words x \d+ bits", run(["vvp", "-n", str(program), "+sram_report"], "memories.log")))


def place_and_route() -> Result:
    run(["nextpnr-ice40", "--hx8k", "--package", "ct256", "--pcf", str(FOLDER / "ice40_hx8k.pcf"), "--json", f"{TOP}.json",
         "--asc", f"{TOP}.asc", "--freq", str(BOARD_MHZ), "--seed", str(SEED), "--report", "report.json"], "nextpnr.log")
    run(["icepack", f"{TOP}.asc", f"{TOP}.bin"], "icepack.log")
    return result(json.loads((BUILD / "report.json").read_text(encoding="utf-8")),
                  run(["icetime", "-d", "hx8k", "-mt", f"{TOP}.asc"], "icetime.log"))


def result(report: dict, icetime: str) -> Result:
    """Of nextpnr's report and icetime's text."""
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


def report(found: Result, cells: dict[str, int], expected_memories: int, test: str) -> str:
    registers = sum(number for kind, number in cells.items() if kind.startswith("SB_DFF"))
    top = parameters()
    share = lambda use: f"{use.used:,} of {use.available:,} ({100 * use.used / use.available:.0f} %)"  # noqa: E731
    return "\n".join([
        "# FPGA demonstrator",
        "",
        f"From `make fpga`: [hdl/demonstrator](../hdl/demonstrator/{TOP}.sv), {top['COLUMNS']} columns of {top['ROWS']} pixels "
        "with hisPointer, photons made on the chip,",
        "a serial line, on an iCE40 HX8K; mapped by Yosys, placed and routed by nextpnr-ice40, packed by icepack.",
        "",
        "| | |",
        "|---|---:|",
        f"| logic cells | {share(found.cells)} |",
        f"| of them look-up tables of four inputs | {cells['SB_LUT4']:,} |",
        f"| flip-flops | {registers:,} |",
        f"| block RAMs, for {expected_memories} memories | {share(found.block_rams)} |",
        f"| highest clock by nextpnr | {found.nextpnr_mhz:.1f} MHz |",
        f"| by icetime | {found.icetime_mhz:.1f} MHz |",
        f"| the board's clock | {BOARD_MHZ} MHz |",
        f"| serial line at that clock | {BOARD_MHZ * 1000 // top['CLOCKS_PER_BIT']:,} kbit/s |",
        f"| bitstream | {(BUILD / f'{TOP}.bin').stat().st_size:,} bytes |",
        "",
        f"The netlist behind the mapping, simulated with Yosys's models of the cells: {test}.",
        "",
    ])  # fmt: skip


def passed(program: Path) -> str:
    """What the test of the netlist printed at its end."""
    text = run([str(program)], "netlist_test.log")
    found = re.search(r"\[  PASSED  \] (\d+) tests", text)
    names = re.findall(r"\[       OK \] \w+\.(\w+)", text)
    if not found or int(found.group(1)) != len(names) or not names:
        raise FlowError("the test of the netlist ran no tests")
    return "passed " + ", ".join(f"`{name}`" for name in names)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--report", type=Path, metavar="TEST", help="run this test of the netlist and write the report")
    arguments = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    kept = BUILD / "result.json"
    if arguments.report:
        test = passed(arguments.report.resolve())
        outcome = json.loads(kept.read_text(encoding="utf-8"))
        found = result(json.loads((BUILD / "report.json").read_text(encoding="utf-8")),
                       (BUILD / "icetime.log").read_text(encoding="utf-8"))  # fmt: skip
        REPORT.write_text(report(found, outcome["cells"], outcome["memories"], test), encoding="utf-8")
        print(f"fpga: the netlist's depths are the model's; wrote {REPORT.relative_to(ROOT)}")
        return 0
    kept.unlink(missing_ok=True)
    cells, expected = synthesise(), memories()
    found = place_and_route()
    sentences = problems(found, cells, expected)
    for sentence in sentences:
        print(f"error: {sentence}", file=sys.stderr)
    if sentences:
        return 1
    kept.write_text(json.dumps({"cells": cells, "memories": expected}), encoding="utf-8")
    print(f"fpga: {found.cells.used} of {found.cells.available} logic cells, {found.block_rams.used} of "
          f"{found.block_rams.available} block RAMs, {found.nextpnr_mhz:.1f} MHz; wrote build/fpga/{TOP}.bin")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
