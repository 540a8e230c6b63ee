#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Maps a small dtof_subsystem of every read-out to four FPGA families with Yosys, and arrays of 32 x 32 and 64 x 64 pixels to two, and
writes reports/fpga_check.md.

The memories are those of hdl/technology/fpga, which ask for block RAM: a family that cannot make block RAM of one of them
stops Yosys. That none became look-up tables is counted, too. --check says whether it holds, and leaves the report alone.
A run whose sources and commands are those of an earlier one is not repeated: build/fpga/ keeps what it counted.
"""

import argparse
import hashlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import fpga_parts
from dtof_synth import program, readouts, statistics
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
BUILD = ROOT / "build" / "fpga"
REPORT = ROOT / "reports" / "fpga_check.md"
TOP = "dtof_subsystem"
SIZE = {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 16, "CLOCK_WAITS": 0}  # hdl/technology/fpga has no clock gate


@dataclass(frozen=True)
class Family:
    """A family's cells by name, and the number of look-up tables in each."""

    title: str
    block_ram: str
    table_ram: str  # memory in look-up tables
    register: str
    tables: dict[str, int]
    units: dict[str, int]  # block RAMs of 18 Kbit in a cell


FAMILIES = {
    "ice40": Family("iCE40", r"SB_RAM40_4K\w*", r"", r"SB_DFF\w*", {"SB_LUT4": 1}, {}),
    "ecp5": Family("ECP5", r"DP16KD|PDPW16KD", r"TRELLIS_DPR16X4", r"TRELLIS_FF", {"LUT4": 1, "CCU2C": 2}, {"DP16KD": 1, "PDPW16KD": 1}),
    "gowin": Family("Gowin", r"(SDP|DP|SP)(X9)?B?", r"RAM16\w+", r"DFF\w*",
                    {"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "ALU": 1}, {}),
    "xilinx": Family("Xilinx 7", r"RAMB(18|36)E1", r"RAM\d+(M|X\d+[DS])\w*", r"FD[CPRS]E\w*",
                     {f"LUT{inputs}": 1 for inputs in range(1, 7)}, {"RAMB18E1": 1, "RAMB36E1": 2}),
}  # fmt: skip


@dataclass(frozen=True)
class Counts:
    block_rams: int
    tables: int
    registers: int
    table_rams: int


def source_files(technology: Path) -> list[str]:
    lines = [line for line in (HDL / "dtof.f").read_text().splitlines() if re.fullmatch(r"[a-z_/0-9]+\.sv", line)]
    return [str(technology / Path(line).name) if line.startswith("technology/") else line for line in lines]


def subsystems() -> dict[str, tuple[str, dict[str, int]]]:
    """Title and parameters of each read-out that the subsystem supports, by name."""
    table = readouts.load()
    found = {}
    for name, readout in table.readouts.items():
        if readout.top:
            number = readout.number if readout.number is not None else table.tops[readout.top].readout
            if number is None:
                continue
            own = {parameter: value for parameter, value in table.defaults(name).items() if parameter in readout.defaults}
            found[name] = (readout.title, {"READOUT": number} | own | SIZE)
    return found


def memories(parameters: dict[str, int]) -> list[str]:
    """Reports of all memories of the subsystem at the start of a simulation."""
    with tempfile.TemporaryDirectory() as folder:
        program = f"{folder}/subsystem.vvp"
        settings = [f"-P{TOP}.{name}={value}" for name, value in parameters.items()]
        subprocess.run(["iverilog", "-g2012", "-s", TOP, *settings, "-o", program, "-f", "dtof.f"], cwd=HDL, check=True)
        text = subprocess.run(["vvp", "-n", program, "+sram_report"], cwd=HDL, check=True, capture_output=True,
                              text=True).stdout  # fmt: skip
    return re.findall(r"\d+ words x \d+ bits", text)


def counted(family: Family, text: str) -> Counts:
    """Numbers of cells in the output of Yosys's stat."""
    cells = statistics.cells(text)

    def total(pattern: str) -> int:
        return sum(number for kind, number in cells.items() if re.fullmatch(pattern, kind)) if pattern else 0

    tables = sum(weight * cells.get(kind, 0) for kind, weight in family.tables.items())
    return Counts(total(family.block_ram), tables, total(family.register), total(family.table_ram))


def mapped(target: str, parameters: dict[str, int], technology: Path) -> str:
    """What Yosys's stat says."""
    settings = " ".join(f"-set {name} {value}" for name, value in parameters.items())
    files = source_files(technology)
    script = (f"read_verilog -sv -DSYNTHESIS -Icommon {' '.join(files)}; "
              f"chparam {settings} {TOP}; synth_{target} -top {TOP}; stat")  # fmt: skip
    texts = [(HDL / file).read_bytes() for file in files] + [file.read_bytes() for file in sorted(HDL.glob("common/*.svh"))]
    kept = BUILD / f"{hashlib.sha256(b'|'.join([script.encode(), *texts])).hexdigest()[:24]}.txt"
    if kept.exists():
        return kept.read_text()
    result = subprocess.run(["yosys", "-Q", "-T", "-p", script], cwd=HDL, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, check=False)  # fmt: skip
    if result.returncode != 0:
        errors = [line for line in result.stdout.splitlines() if line.startswith("ERROR")]
        raise FlowError(errors[-1] if errors else "Yosys failed")
    text = statistics.last(result.stdout)
    BUILD.mkdir(parents=True, exist_ok=True)
    kept.write_text(text)
    return text


def needed(family: Family, text: str) -> fpga_parts.Need:
    cells = statistics.cells(text)
    counts = counted(family, text)
    return fpga_parts.Need(counts.tables, counts.registers, sum(units * cells.get(kind, 0) for kind, units in family.units.items()))


def problem(expected: list[str], counts: Counts) -> str:
    """Fault of the memories; empty if there is none."""
    if counts.table_rams:
        return f"{counts.table_rams} look-up tables are memory"
    if counts.block_rams < len(expected):
        return f"{counts.block_rams} block RAMs for {len(expected)} memories"
    return ""


def report(rows: dict[str, dict[str, Counts]], expected: dict[str, list[str]], titles: dict[str, str], arrays: list[str]) -> str:
    size = f"{SIZE['SRAM_NUM']} columns of {SIZE['PIXELS_PER_SRAM']} pixels"
    lines = [
        "# FPGA",
        "",
        f"From `make fpga-check`: `dtof_subsystem` with {size} and CLOCK_WAITS = 0, with each read-out, its registers, line buffer and result "
        "stream,",
        "mapped by Yosys; nothing is placed or routed. Memories are those of `hdl/technology/fpga`. Every memory became "
        "block RAM in every",
        "family. Look-up tables include those of carry chains.",
        "",
        "| read-out | memories | " + " | ".join(
            f"{family.title}: block RAMs | look-up tables | flip-flops" for family in FAMILIES.values()) + " |",
        "|---|---:|" + "---:|" * (3 * len(FAMILIES)),
    ]  # fmt: skip
    for name, by_family in rows.items():
        figures = " | ".join(f"{by_family[target].block_rams} | {by_family[target].tables:,} | "
                             f"{by_family[target].registers:,}" for target in FAMILIES)
        lines.append(f"| {titles[name]} | {len(expected[name])} | {figures} |")
    return "\n".join([*lines, "", *arrays])


def arrays(technology: Path, titles: dict[str, str], jobs: int) -> list[str]:
    """The report's section of larger arrays."""
    known = subsystems()
    with ThreadPoolExecutor(max_workers=jobs) as pool:
        runs = {(name, size, family): pool.submit(mapped, family, known[name][1] | {"SRAM_NUM": size, "PIXELS_PER_SRAM": size}, technology)
                for family in fpga_parts.PARTS for size in fpga_parts.SIZES for name in fpga_parts.READOUTS}
        needs = {}
        for (name, size, family), run in runs.items():
            needs[name, size, family] = needed(FAMILIES[family], run.result())
            print(f"[{len(needs)}/{len(runs)}] {name}, {size} x {size}, {FAMILIES[family].title}", flush=True)
    return fpga_parts.section(needs, titles, {family: FAMILIES[family].title for family in fpga_parts.PARTS})


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("readouts", nargs="*", help="names of read-outs; all if none is given")
    parser.add_argument("--families", nargs="*", default=list(FAMILIES), choices=FAMILIES, help="all if not given")
    parser.add_argument("--technology", type=Path, default=HDL / "technology/fpga", help="folder of the memories")
    parser.add_argument("--check", action="store_true", help="leave the report alone")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    arguments = parser.parse_args()

    known = subsystems()
    unknown = set(arguments.readouts) - known.keys()
    if unknown:
        raise FlowError(f"no read-out with RTL is called '{sorted(unknown)[0]}'")
    chosen = {name: known[name] for name in arguments.readouts or known}
    expected = {name: memories(parameters) for name, (_, parameters) in chosen.items()}
    rows: dict[str, dict[str, Counts]] = {name: {} for name in chosen}
    failures = []
    with ThreadPoolExecutor(max_workers=arguments.jobs) as pool:
        runs = {(name, target): pool.submit(mapped, target, parameters, arguments.technology.resolve())
                for name, (_, parameters) in chosen.items() for target in arguments.families}
        for (name, target), run in runs.items():
            try:
                rows[name][target] = counted(FAMILIES[target], run.result())
                sentence = problem(expected[name], rows[name][target])
            except FlowError as error:
                sentence = str(error)
            if sentence:
                failures.append(f"{name}, {FAMILIES[target].title}: {sentence}")
    for sentence in failures:
        print(f"error: {sentence}", file=sys.stderr)
    if failures:
        return 1
    print(f"fpga-check: all memories of {len(chosen)} subsystems become block RAM ({', '.join(arguments.families)})")
    if not arguments.check and chosen.keys() == known.keys() and set(arguments.families) == FAMILIES.keys():
        titles = {name: title for name, (title, _) in chosen.items()}
        REPORT.write_text(report(rows, expected, titles, arrays(arguments.technology.resolve(), titles, arguments.jobs)), encoding="utf-8")
        print(f"wrote {REPORT.relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    try:
        program.run(main)
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
