#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the cases that outsiders reported: every folder of ../shared/cases, or of another folder.

    scripts/cases.py [FOLDER] [--quick] [--only NAME ...]

A folder has the inputs and a README that says what was run and seen. What is expected stands here: a function for each folder, which
raises CaseError where something else happens. A line is printed for each, and "N of N cases" at the end; the exit status is 1 if one
fails or a folder has no function. --quick leaves out those that build or configure the project again. The programs are those of
build/cpp/bin; a case without its tool (Verilator, Icarus Verilog) fails."""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import case_tools as tools
import file_lists
from case_tools import DTOF, ROOT, CaseError, archive, depth_map, refused, require, require_depths, require_heading, run, shell, succeed, with_shot
from dtof_synth import program

CASES = ROOT.parent / "shared" / "cases"
HDL = ROOT / "hdl"
Words = tuple[tuple[str | Path, ...], ...]
PIXELS = 16  # of the depth maps


@dataclass(frozen=True)
class Case:
    """A reported case: `folder` has its inputs; `work` is an empty folder."""

    folder: Path
    work: Path


Rule = Callable[[Case], None]
QUICK: dict[str, Rule] = {}
SLOW: dict[str, Rule] = {}


def rule(function: Rule) -> Rule:
    QUICK[function.__name__] = function
    return function


def slow_rule(function: Rule) -> Rule:
    SLOW[function.__name__] = function
    return function


def dtof(case: Case, *arguments: str | Path, text: bytes | None = None) -> tools.Done:
    return run(DTOF, *arguments, folder=case.work, text=text)


def replay(case: Case, file: str | Path, *options: str | Path) -> tools.Done:
    return dtof(case, "replay", file, "--readout", "ezpointer", "--out", "out", *options)


def frame(case: Case, *options: str | Path) -> tools.Done:
    return dtof(case, "frame", "--readout", "ezpointer", "--table", "none", "--columns", "0-1", "--out", "out", *options)


def true_distances(case: Case) -> list[float]:
    """True distances in mm for the measurements of a replay."""
    lines = (case.work / "out" / "measurements.csv").read_text(encoding="utf-8").splitlines()[1:]
    return [float(line.split(",")[0]) for line in lines]


# Maps.


@rule
def npy_types(case: Case) -> None:
    for name, scale in (("be_f4", 1.0), ("f2", 1.0), ("v3", 1.0), ("i2_mm", 0.001), ("u8_mm", 0.001)):
        file = case.folder / f"{name}.npy"
        require_depths(depth_map(case.work, file, "--depth-scale", str(scale)), [value * scale for value in tools.npy(file)], name)
    for name in ("h_i2", "h_u8"):
        file = case.folder / f"{name}.npy"
        require_heading(succeed(dtof(case, "replay", file, "--bin-width", "500", "--readout", "histogram", "--out", "out")),
                        "2 columns x 2 rows")  # fmt: skip
        counts, codes = tools.npy(file), (case.work / "out" / "histogram.csv").read_text(encoding="utf-8").splitlines()[1:]
        for line in codes:
            column, row, code = (int(value) for value in line.split(",")[:3])
            bins = counts[(row * 2 + column) * 64 : (row * 2 + column + 1) * 64]
            middle = sum((i + 0.5) * count for i, count in enumerate(bins)) / sum(bins) * 500 / (45000 / 1024)
            require(abs(code - middle) < 30, f"{name}: code {code} for a peak at {middle:.0f}")  # 30 codes: the pulse


@rule
def npy_empty(case: Case) -> None:
    refused(frame(case, "--depth", case.folder / "zero.npy"), "zero.npy: the array is empty: shape (4, 0) has no element")


@rule
def pfm_headers(case: Case) -> None:
    for name, order, scale in (("scale", "<", 0.003922), ("crlf", "<", 1.0), ("comment", "<", 1.0), ("spaces", "<", 1.0), ("plus", ">", 1.0)):
        file = case.folder / f"{name}.pfm"
        truth = tools.floats_from_below(file.read_bytes()[-4 * PIXELS :], 4, 4, order)
        # Numbers that the scale makes small become metres again by --depth-scale.
        require_depths(depth_map(case.work, file, "--depth-scale", str(1.0 / scale)), truth, name)


@rule
def png_kinds(case: Case) -> None:
    key = case.folder / "g16_trns.png"
    grey = [value for row in tools.png(key)[3] for value in row]
    require_depths(depth_map(case.work, key), [None if value == 1000 else value / 1000 for value in grey], "a tRNS key")
    require_depths(depth_map(case.work, case.folder / "ga16.png"), [value / 1000 for value in grey], "an opaque alpha")
    red = [value for row in tools.png(case.folder / "rgb8_grey.png")[3] for value in row[::3]]
    require_depths(depth_map(case.work, case.folder / "rgb8_grey.png", "--depth-scale", "0.02"), [value * 0.02 for value in red], "grey as RGB")


@rule
def depth_beyond_range(case: Case) -> None:
    for name in ("beyond10m.npy", "u2_mm.npy"):
        refused(frame(case, "--depth", case.folder / name), name, "every pixel is beyond the sensor's range, 6.75 m")
    refused(replay(case, case.folder / "t20_mm.json", "--photons", "100"), "t20_mm.json", "every true distance is beyond the range, 6.75 m")


@rule
def depth_float_overflow(case: Case) -> None:
    refused(frame(case, "--depth", case.folder / "f8_1e39.npy"), "f8_1e39.npy: column 0, row 0: a depth of 1e+39 m is too large a number")


@rule
def reflectivity_beyond_model(case: Case) -> None:
    for name, value in (("refl_100.npy", "100"), ("refl_1e30.npy", "1e+30")):
        refused(frame(case, "--depth", case.folder / "f8.npy", "--reflectivity-map", case.folder / name),
                f"{name}: column 0, row 0: a reflectivity of {value} is not within 0 to 4")  # fmt: skip


# Recordings.


@rule
def stream_text_variants(case: Case) -> None:
    succeed(replay(case, case.folder / "s_ok.csv.gz"))
    wanted = (case.work / "out" / "ezpointer.csv").read_text(encoding="utf-8")
    files = sorted(path for path in case.folder.iterdir() if path.name.startswith("s_"))
    require(len(files) == 8, f"{len(files)} files instead of 8")
    for file in files:
        acquisitions = 4 if file.name == "s_minus1.csv" else 3  # the last one saw nothing
        require_heading(succeed(replay(case, file)), f"6 detections): 2 columns x 1 rows, {acquisitions} acquisitions")
        require((case.work / "out" / "ezpointer.csv").read_text(encoding="utf-8") == wanted, f"{file.name}: other codes")
    half = case.work / "half.csv"
    half.write_text("acquisition,column,row,timestamp\n0,0,0,100.5\n", encoding="utf-8")
    refused(replay(case, half), 'half.csv:2: timestamp "100.5" is not a decimal integer')


@rule
def tmf8820_variants(case: Case) -> None:
    read = lambda name: succeed(replay(case, case.folder / name, "--photons", "100"))  # noqa: E731
    require_heading(read("t20_float.json"), "1 captures of 9 zones")
    require(true_distances(case) == [100.0] * 9, "t20_float.json: other distances")
    for name, unknown in (("t20_nan.json", 1), ("t20_zero.json", 1), ("t20_noref.json", 0)):
        require_heading(read(name), "6 captures of 9 zones", "6 columns x 9 rows")
        truths = sorted(set(true_distances(case)))
        require(truths == [100.0 * i for i in range(1 + unknown, 7)], f"{name}: true distances {truths}")
    shutil.rmtree(case.work / "out")
    require_heading(read("t20_serial.log"), "ams TMF8820, 1 captures of 9 zones): 1 columns x 9 rows")
    require(not (case.work / "out" / "measurements.csv").exists(), "a serial log has no distance")


def tmf8829(case: Case, name: str, columns: int, rows: int, *parts: str) -> None:
    require_heading(succeed(replay(case, case.folder / name, "--photons", "100")), f"{columns} columns x {rows} rows", *parts)
    require(set(true_distances(case)) <= {1018.2, 1018.3}, f"other distances: {set(true_distances(case))}")  # 1018.25, rounded
    require(len(true_distances(case)) == columns * rows, f"{len(true_distances(case))} distances")


@rule
def tmf8829_8x8(case: Case) -> None:
    tmf8829(case, "t29_8x8_256bins.json", 8, 8, "ams TMF8829, 1 frames)")


@rule
def tmf8829_bom(case: Case) -> None:
    tmf8829(case, "t29_bom.json", 4, 4, "ams TMF8829, 1 frames)")


@rule
def tmf8829_client_distance(case: Case) -> None:
    tmf8829(case, "t29_client_distance.json", 4, 4, "ams TMF8829, 1 frames)")


@rule
def tmf8829_one_bad_frame(case: Case) -> None:
    tmf8829(case, "t29_emptyframe.json", 8, 4, "ams TMF8829, 2 frames, 1 without results or histograms left out)")


@rule
def error_without_file_name(case: Case) -> None:
    for name, place in (("h_frac.npy", "column 0, row 0, bin 3: count 0.5"), ("h_nan.npy", "column 0, row 0, bin 3: count nan"),
                        ("h_neg.npy", "column 0, row 0, bin 0: count -1")):  # fmt: skip
        refused(replay(case, case.folder / name, "--bin-width", "700"), f"dtof: error: {case.folder / name}: {place} is not ")


@rule
def photons_beyond_range(case: Case) -> None:
    late = (case.folder / "h_late.npy", "--bin-width", "1000")
    truths: Words = ((), ("--truth", case.folder / "truth2.npy", "--offset", "0"))
    for truth in truths:
        refused(replay(case, *late, *truth), "h_late.npy: all 2000 photons of the pixels read are outside the range, 0 to 45 ns")


# Pipes, streams, names.


@rule
def pipe(case: Case) -> None:
    map_file = other_case(case, "reflectivity_beyond_model") / "f8.npy"
    succeed(frame(case, "--depth", map_file))
    wanted = (case.work / "out" / "summary.csv").read_bytes()
    shutil.rmtree(case.work / "out")
    frame_line = "frame --readout ezpointer --table none --columns 0-1 --out out --depth"
    for command in (f"$DTOF {frame_line} <(cat '{map_file}')", f"cat '{map_file}' | $DTOF {frame_line} /dev/stdin"):
        succeed(shell(command, case.work))
        require((case.work / "out" / "summary.csv").read_bytes() == wanted, "a pipe gives other figures than the file")
        shutil.rmtree(case.work / "out")
    captures = other_case(case, "tmf8820_variants") / "t20_noref.json"
    for options in ("--format tmf8820", ""):
        done = succeed(shell(f"$DTOF replay <(gzip -c '{captures}') {options} --photons 100 --readout ezpointer --out out", case.work))
        require_heading(done, "6 captures of 9 zones")


def other_case(case: Case, name: str) -> Path:
    """Folder of another case whose inputs this case uses."""
    return case.folder.parent / name


def pictures(folder: Path) -> list[Path]:
    return sorted(path for path in folder.glob("*.png") if not path.name.endswith("_mm.png"))


@rule
def latin1_name(case: Case) -> None:
    name = os.fsencode(case.work) + b"/mess\xfcng.npy"
    shutil.copyfile(other_case(case, "reflectivity_beyond_model") / "f8.npy", name)
    succeed(frame(case, "--depth", os.fsdecode(name)))
    drawn = pictures(case.work / "out")
    require(len(drawn) == 4, f"{len(drawn)} pictures instead of 4")
    for picture in drawn:
        colours = {value for row in tools.png(picture)[3] for value in row}
        require(len(colours) > 10, f"{picture.name} has {len(colours)} colours")


@rule
def spaces_in_command(case: Case) -> None:
    shutil.copyfile(other_case(case, "reflectivity_beyond_model") / "f8.npy", case.work / "a b&c.npy")
    succeed(dtof(case, "frame", "--readout", "ezpointer", "--table", "none", "--columns", "0-1", "--depth", "a b&c.npy", "--out", "x y"))
    text = (case.work / "x y" / "summary.md").read_text(encoding="utf-8")
    command = next(line for line in text.splitlines() if line.startswith("Command: ")).removeprefix("Command: ").strip("`")
    (case.work / "x y").rename(case.work / "first")
    succeed(shell(command.replace("dtof", "$DTOF", 1), case.work))
    require((case.work / "x y" / "summary.md").read_text(encoding="utf-8") == text, "the command makes another page")


@rule
def full_disk(case: Case) -> None:
    for command in ("sensor thesis", "list"):
        done = shell(f"$DTOF {command} > /dev/full", case.work)
        require(done.code != 0, f"{command}: exit status 0")
        require(done.error == "dtof: error: standard output: cannot write: No space left on device\n", f"{command}: {done.error!r}")


@rule
def std_streams(case: Case) -> None:
    done = shell("$DTOF frame --sensor nothere 2>&-", case.work)
    require(done.code == 1, f"exit status {done.code} instead of 1")
    succeed(shell("$DTOF frame --scene flat --readout ezpointer --table none --columns 0-1 --out out 2>&- <&-", case.work))
    require((case.work / "out" / "summary.csv").read_text(encoding="utf-8").startswith("read-out,"), "a file has what standard error had")
    require(shell("$DTOF sensor thesis >&-", case.work).code != 0, "standard output closed: exit status 0")


# Sensors.


@rule
def sensor_dead(case: Case) -> None:
    succeed(dtof(case, "frame", "--sensor", case.folder / "dead.toml", "--scene", "flat", "--distance", "1", "--out", "out"))
    maps = sorted((case.work / "out").glob("*_depth_mm.png"))
    require(len(maps) > 5, f"{len(maps)} depth maps")
    for path in maps:
        # docs/reference/poolpointer.md: without detections only an engine's first column has the confidence 0.
        columns = 1 if path.name.startswith("poolpointer") else None
        require(not any(any(row[:columns]) for row in tools.png(path)[3]), f"{path.name}: a dead pixel has a distance")
        cloud = path.with_name(path.name.replace("_depth_mm.png", ".ply"))
        require(columns == 1 or b"\nelement vertex 0\n" in cloud.read_bytes()[:400], f"{cloud.name} has a point")


@rule
def sensor_far(case: Case) -> None:
    done = succeed(dtof(case, "frame", "--sensor", case.folder / "far.toml", "--scene", "flat", "--distance", "100", "--out", "out"))
    require("ezpointer_depth_mm.png is left out: " in done.text, "no line says that the PNG is left out")
    require((case.work / "out" / "summary.csv").exists(), "no summary")


@rule
def sensor_wide(case: Case) -> None:
    succeed(dtof(case, "frame", "--sensor", case.folder / "vga.toml", "--readout", "ezpointer", "--table", "none", "--scene", "flat",
                 "--out", "out"))  # fmt: skip
    require((case.work / "out" / "ezpointer.ply").exists(), "no point cloud")


# RTL in designs of others.


@rule
def module_names(case: Case) -> None:
    own = (case.folder / "own_line_buffer.sv", with_shot(case.folder / "soc.sv", case.work))
    orders: Words = (("-f", "dtof.f", *own), (*own, "-f", "dtof.f"))
    for files in orders:
        # One of the two files of the case has a `timescale: Verilator would complain about the other.
        done = run("verilator", "--lint-only", "-Wno-TIMESCALEMOD", *files, "--top-module", "soc", folder=HDL)
        require("MODDUP" not in done.text, "a module of the user's has a name of the RTL's")
        succeed(done)


@rule
def timescale(case: Case) -> None:
    chip = with_shot(case.folder / "soc.sv", case.work)
    orders: Words = (("-f", "dtof.f", chip), (chip, "-f", "dtof.f"))
    for files in orders:
        succeed(run("verilator", "--lint-only", *files, "--top-module", "soc", folder=HDL))
    bench: list[str | Path] = ["-f", "dtof.f", ROOT / "examples" / "example_bench.sv", "--top-module", "example_bench"]
    done = run("verilator", "--lint-only", "--timing", *bench, folder=HDL)
    require("TIMESCALEMOD" not in done.text, "TIMESCALEMOD of the example's bench")


@rule
def use_before_declaration(_case: Case) -> None:
    done = succeed(run("iverilog", "-g2012", "-Wall", "-t", "null", "-f", "dtof.f", "-s", "dtof_subsystem", folder=HDL))
    require("implicit" not in done.text, next((line for line in done.text.splitlines() if "implicit" in line), ""))


def has_commit() -> bool:
    """True if software commits all its settings together."""
    return any("] COMMIT = " in path.read_text(encoding="utf-8") for path in HDL.rglob("dtof_registers_pkg.sv"))


@rule
def torn_settings(case: Case) -> None:
    bench = (case.folder / "torn_bench.sv").read_text(encoding="utf-8")
    # The read-out's name was another one when the case was reported.
    former = "READOUT_POOLPOINTER2"
    require(bench.count(former) == 1, f"torn_bench.sv: no '{former}'")
    bench = bench.replace(former, "READOUT_POOLPOINTER")
    # Registers that are committed together take the last of the writes.
    if has_commit():
        last = "write(dtof_registers_pkg::TRACK_END, 8);"
        require(bench.count(last) == 1, f"torn_bench.sv: no '{last}'")
        bench = bench.replace(last, last + " write(dtof_registers_pkg::COMMIT, 1);")
    # The bench never says where an acquisition ends, which the line buffer needs.
    require(bench.count(".s_axis_tlast_i(1'b0)") == 1, "torn_bench.sv has another tlast")
    bench = bench.replace(".s_axis_tlast_i(1'b0)", ".s_axis_tlast_i(beat == 2 * ROWS - 1)")
    bench = bench.replace("  dtof_subsystem #(", """  int beat = 0;
  always @(posedge clk) if (rst_n && s_ready) beat <= beat == 2 * ROWS - 1 ? 0 : beat + 1;
  dtof_subsystem #(""", 1)
    (case.work / "torn_bench.sv").write_text(bench, encoding="utf-8")
    succeed(run("iverilog", "-g2012", "-s", "torn_bench", "-Ptorn_bench.GAP=3000", "-o", case.work / "t.vvp", "-f", "dtof.f",
                case.work / "torn_bench.sv", folder=HDL))  # fmt: skip
    done = succeed(run("timeout", "120", "vvp", "t.vvp", folder=case.work))
    require("ILLEGAL_SCHEDULE 0" in done.text and "BUSY 1" in done.text, " ".join(done.text.split("\n")[:2]))


# The C++ package and the build.


def installed(case: Case) -> Path:
    prefix = case.work / "prefix"
    succeed(run("cmake", "--install", ROOT / "build" / "cpp", "--component", "models", "--prefix", prefix, folder=case.work))
    return prefix


def consumer(case: Case, prefix: Path, **environment: str) -> tools.Done:
    """Configures the case's project, which was written for version 0.2, with the present version and include paths as for installed headers."""
    source = case.work / "source"
    shutil.copytree(case.folder, source, copy_function=shutil.copyfile)
    present = {f'#include "{library}/': f'#include "dtof/{library}/' for library in ("readout", "sensor")}
    present["find_package(dtof 0.2"] = "find_package(dtof " + file_lists.version().rpartition(".")[0]
    for file in [*source.glob("*.cpp"), source / "CMakeLists.txt"]:
        text = file.read_text(encoding="utf-8")
        for old, new in present.items():
            text = text.replace(old, new)
        file.write_text(text, encoding="utf-8")
    return run("cmake", "-S", source, "-B", case.work / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}", folder=case.work, text=None,
               **environment)


@slow_rule
def consumer_cxx17(case: Case) -> None:
    succeed(consumer(case, installed(case)))
    succeed(run("cmake", "--build", "build", folder=case.work))
    succeed(run(case.work / "build" / "consumer", folder=case.work))


@slow_rule
def consumer_quiet(case: Case) -> None:
    done = succeed(consumer(case, installed(case), PKG_CONFIG_LIBDIR="/nonexistent", PKG_CONFIG_PATH=""))
    require("found: 0" in done.text, "the package is found without tomlplusplus")


@slow_rule
def consumer_shared(case: Case) -> None:
    succeed(consumer(case, installed(case)))
    succeed(run("cmake", "--build", "build", folder=case.work))


@slow_rule
def moved_build(case: Case) -> None:
    first = archive(case.work / "first")
    succeed(run("make", "configure", folder=first))
    first.rename(case.work / "second")
    done = succeed(run("make", "configure", folder=case.work / "second"))
    require("is different" not in done.text, "CMake complains about the folder")
    cache = (case.work / "second" / "build" / "cpp" / "CMakeCache.txt").read_text(encoding="utf-8")
    require(str(case.work / "second") in cache and str(first) not in cache, "the cache has the first folder")


@slow_rule
def release_flags(case: Case) -> None:
    build = case.work / "b"
    succeed(run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O3 -DX",
                "-DCMAKE_CXX_COMPILER_LAUNCHER=env", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", folder=case.work))  # fmt: skip
    commands = [one["command"] for one in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
                if " -o models/dtof/" in one["command"]]  # fmt: skip
    require(len(commands) > 10, f"{len(commands)} commands")
    for command in commands:
        require("-O3 -DX" in command and "-O2" not in command, f"other flags: {command[:300]}")
    rules = (build / "CMakeFiles" / "rules.ninja").read_text(encoding="utf-8")
    require("ccache" not in rules and "env " in rules, "another launcher than the one given")


@slow_rule
def tarball(case: Case) -> None:
    """Outside a repository the lint reads the files of the archive, all of them, and waits for nothing."""
    folder = archive(case.work / "T")
    done = succeed(run("bash", "scripts/lint.sh", "--quick", folder=folder, GIT_CEILING_DIRECTORIES=str(case.work)))
    modules = len(list(folder.rglob("*.py")))
    require(f"pyflakes: {modules} files clean" in done.text, f"the lint reads other files than the {modules} modules of the archive")
    require("Traceback" not in done.text, "a traceback without a repository")
    succeed(run("make", "configure", folder=folder, GIT_CEILING_DIRECTORIES=str(case.work)))


def check(folder: Path, rules: dict[str, Rule]) -> str:
    """Runs a case; returns the fault, or an empty text."""
    function = rules.get(folder.name)
    if function is None:
        return "no rule says what is expected"
    with tempfile.TemporaryDirectory() as work:
        try:
            function(Case(folder, Path(work)))
        except CaseError as error:
            return str(error)
        except (OSError, subprocess.TimeoutExpired) as error:  # a tool or a file that is not there; a step that does not end
            return f"{type(error).__name__}: {error}"
    return ""


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description="runs the cases that outsiders reported")
    parser.add_argument("folder", nargs="?", type=Path, default=CASES)
    parser.add_argument("--quick", action="store_true", help="without those that configure or build")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME")
    options = parser.parse_args(arguments)
    if not options.folder.is_dir():
        print(f"skipped: {options.folder} is absent")
        return 0
    folders = sorted(path for path in options.folder.iterdir() if path.is_dir())
    folders = [path for path in folders if (not options.only or path.name in options.only) and not (options.quick and path.name in SLOW)]
    if not DTOF.is_file():
        print(f"error: {DTOF} is not built (make build)")
        return 1
    good = 0
    for path in folders:
        start = time.monotonic()
        fault = check(path.resolve(), QUICK | SLOW)
        good += not fault
        print(f"{path.name:28} {time.monotonic() - start:6.1f} s  {fault and f'FAILED: {fault}' or 'good'}", flush=True)
    print(f"{good} of {len(folders)} cases")
    return 0 if good == len(folders) else 1


if __name__ == "__main__":
    program.run(lambda: main(sys.argv[1:]))
