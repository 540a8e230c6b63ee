# SPDX-License-Identifier: Apache-2.0
"""Small arrays simulated four-state in Icarus Verilog: RTL against model, and netlist against RTL and model."""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, replace
from pathlib import Path

from . import cell_models, floorplan, liberty, netlist, sram_kit, tools
from .configuration import Configuration, macro_sizes
from .errors import FlowError
from .mapping import efforts, elaborate, map_to_cells, rtl_files
from .technology import Technology

VECTORS = Path("build/cpp/bin/dtof-vectors")
BENCHES = Path("synth/simulation")
BEHAVIOURAL = Path("hdl/technology/behavioural")
SHORT_FRAMES = (30, 160)  # acquisitions of a random frame
LONG_FRAME = 3333
FULL_FRAME = 96
FULL_WIDTH = ("ezpointer", "hispointer", "poolpointer")
LONGEST_RUN_S = 1200
NETLIST_SUFFIX = "_netlist"


@dataclass(frozen=True)
class Case:
    """Frames of one small array in one simulation."""

    configuration: Configuration
    frames: tuple[int, ...]  # acquisitions of each
    seed: int
    trace: Path | None = None  # waveform to write
    part: str = ""  # of a configuration's frames, if there are several cases

    @property
    def name(self) -> str:
        return self.configuration.name

    @property
    def title(self) -> str:
        return f"{self.name}, {self.part}" if self.part else self.name


@dataclass(frozen=True)
class Outcome:
    """Figures of a simulation without failures."""

    frames: int
    results: int
    clocks: int
    seconds: float


def expected_rank(configuration: Configuration) -> int:
    """Sort key: configurations with the longest simulations first."""
    return 0 if configuration.is_pool else 1 if configuration.readout in ("histogram", "pifh") else 2


def short_frames(seed: int, count: int) -> tuple[int, ...]:
    """Frames of 0, 1 and 2 acquisitions and some random frames. None of the short ones comes first, so that each follows another frame."""
    numbers = random.Random(seed)
    longer = [numbers.randint(*SHORT_FRAMES) for _ in range(count)]
    return (longer[0], 0, 1, 2, *longer[1:])


def rtl_case(configuration: Configuration, seed: int, trace: Path | None = None) -> Case:
    """Case for the RTL alone, with three columns. A pool read-out has an engine with three pairs of columns and one with one pair; two of
    the pairs share an SRAM, and a column has two groups."""
    if configuration.is_pool:
        small = {"SRAM_NUM": 8, "ENGINE_COLUMNS": 6, "PIXELS_PER_SRAM": configuration["GROUP_SIZE"] + 2}
    else:
        small = {"SRAM_NUM": 3, "PIXELS_PER_SRAM": 3 if configuration.readout == "histogram" else 5}
    return Case(configuration.with_parameters(configuration.name, **small), short_frames(seed, 4), seed, trace)


def netlist_cases(configuration: Configuration, seed: int, trace: Path | None = None) -> list[Case]:
    """Cases for the netlist beside the RTL. With three pixels, the fewest possible, histograms are forwarded as in a full array. A pool
    read-out's long frame has a small array of its own (two pixels, one engine) to save time."""
    if not configuration.is_pool:
        small = configuration.with_parameters(configuration.name, SRAM_NUM=2, PIXELS_PER_SRAM=3)
        return [Case(small, (*short_frames(seed, 2), LONG_FRAME), seed, trace)]
    one_pair = {"SRAM_NUM": 2, "ENGINE_COLUMNS": 2, "PIXELS_PER_SRAM": 2}
    return [replace(rtl_case(configuration, seed, trace), frames=short_frames(seed, 2)),
            Case(configuration.with_parameters(configuration.name, **one_pair), (LONG_FRAME,), seed,
                 trace and trace.with_stem(f"{trace.stem}_long"), "long")]


def full_case(configuration: Configuration, seed: int) -> Case:
    """Case for the netlist of the full-width array with few pixels per column: a frame, then the start of a frame up to a reset."""
    pixels = configuration["GROUP_SIZE"] + 2 if configuration.is_pool else 3
    return Case(configuration.with_parameters(configuration.name, PIXELS_PER_SRAM=pixels), (FULL_FRAME,), seed,
                part="full width")


def write_netlist(configuration: Configuration, technology: Technology, folder: Path, seed: int) -> tuple[Path, ...]:
    """Runs a configuration through the flow's steps; writes netlist, cells and macros as Verilog and returns the files."""
    elaborate(configuration, technology, folder)
    design = map_to_cells(configuration, technology, folder, efforts(configuration)[0])
    floorplan.finish(design, technology.slow, sram_kit.PIN_FF, configuration)
    return write_simulation_netlist(design, configuration, technology, folder, seed)


def write_simulation_netlist(design: dict, configuration: Configuration, technology: Technology, folder: Path,
                             seed: int) -> tuple[Path, ...]:
    """Writes Verilog of a mapped design, of the cells that it uses and of its macros."""
    drawn = random.Random(seed)
    kinds = netlist.cell_kinds(design, technology.slow)
    netlist.prepare_simulation(design, technology.slow, NETLIST_SUFFIX, cell_models.POWER_UP,
                               lambda: drawn.random() < 0.5)
    source, written = folder / "simulation.json", folder / "netlist.v"
    source.write_text(json.dumps(design), encoding="utf-8")
    settings = folder / "write_settings.tcl"
    tools.write_settings(settings, {"netlist_json": source, "netlist": written})
    tools.run_yosys(technology.root / "synth" / "yosys" / "write_verilog.tcl", settings, folder / "write.log",
                    configuration.name)
    cells, macros = folder / "cells.v", folder / "macros.v"
    cells.write_text(cell_models.verilog(liberty.read(technology.slow.path), kinds), encoding="utf-8")
    macros.write_text(sram_kit.behavioural_models(macro_sizes(configuration)), encoding="utf-8")
    return written, cells, macros


def _run(command: list[str], folder: Path, name: str) -> str:
    try:
        finished = subprocess.run(command, cwd=folder, check=False, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=LONGEST_RUN_S)
    except subprocess.TimeoutExpired:
        raise FlowError(f"{name}: {Path(command[0]).name} does not end: stopped after {LONGEST_RUN_S} s") from None
    except FileNotFoundError:
        hint = "make builds it" if Path(command[0]).name == VECTORS.name else "scripts/install_packages.sh installs it"
        raise FlowError(f"{command[0]} is missing; {hint}") from None
    if finished.returncode != 0:
        tool = Path(command[0]).name
        log = folder / f"{tool}.log"
        log.write_text(finished.stdout, encoding="utf-8")
        lines = [line for line in finished.stdout.splitlines() if line.strip()] or ["failed silently"]
        told = next((line for line in lines if re.search("error|fatal", line, re.IGNORECASE)), lines[-1])
        raise FlowError(f"{name}: {tool}: {told.strip()} (see {log})")
    return finished.stdout


def _lines(path: Path) -> int:
    return path.read_text(encoding="ascii").count("\n")


def write_vectors(case: Case, root: Path, folder: Path, options: tuple[str, ...] = ()) -> None:
    """Writes stimulus and the model's results with the program dtof-vectors and additional `options`."""
    settings = [f"{name}={value}" for name, value in case.configuration.parameters.items()]
    _run([str(root / VECTORS), "--readout", case.configuration.readout, "--out", str(folder), "--seed",
          str(case.seed), "--acquisitions", *map(str, case.frames), *options, "--parameters", *settings], folder,
         case.name)


def bench_parameters(case: Case, folder: Path) -> dict[str, int]:
    """Parameters of the bench: those of the array, and the lengths of dtof-vectors' files."""
    return {**case.configuration.rtl_parameters(), "FRAMES": len(case.frames),
            "BEATS": max(1, _lines(folder / "timestamps.hex")), "SEED": case.seed}


def bench_files(case: Case, root: Path) -> list[Path]:
    """Files of the bench: RTL, behavioural SRAMs and the bench itself."""
    return [*rtl_files(root)[:1], *sorted((root / BEHAVIOURAL).glob("*.sv")), *rtl_files(root)[1:],
            root / BENCHES / "stream_bench.sv", root / BENCHES / f"{case.configuration.top}_bench.sv"]


def outcome(output: str, case: Case, seconds: float) -> Outcome:
    """Judges a simulation. FlowError with the report of the bench or of an RTL assertion, unless all frames passed."""
    passed = re.search(r"^DTOF_PASS frames (\d+) results (\d+) clocks (\d+)$", output, re.MULTILINE)
    if passed and "ERROR" not in output and int(passed.group(1)) == len(case.frames):
        frames, results, clocks = map(int, passed.groups())
        return Outcome(frames, results, clocks, seconds)
    lines = [line for line in output.splitlines() if line.strip()]
    first = next((index for index, line in enumerate(lines) if line.startswith("ERROR")), 0)
    raise FlowError(f"{case.title}: {'; '.join(lines[first:first + 4]) or 'the simulation printed nothing'}")


def simulate_netlist(case: Case, technology: Technology, folder: Path) -> Outcome:
    """Makes a netlist from RTL and compares both, in `folder`."""
    return simulate(case, technology.root, folder, write_netlist(case.configuration, technology, folder, case.seed))


def compile_bench(case: Case, root: Path, folder: Path, netlist_files: Sequence[Path] = (),
                  other_tops: Sequence[str] = ()) -> None:
    """Compiles bench.vvp in `folder`. FlowError for any message of Icarus Verilog."""
    bench = f"{case.configuration.top}_bench"
    overrides = [f"-P{bench}.{name}={value}" for name, value in bench_parameters(case, folder).items()]
    tops = [word for top in (bench, *other_tops) for word in ("-s", top)]
    said = _run(["iverilog", "-g2012", f"-I{root / 'hdl' / 'common'}", *tops, *overrides,
                 *(["-DNETLIST"] if netlist_files else []), "-o", "bench.vvp",
                 *map(str, bench_files(case, root)), *map(str, netlist_files)], folder, case.name)
    if said.strip():
        raise FlowError(f"{case.name}: Icarus Verilog warns: {said.strip().splitlines()[0]}")


def simulate(case: Case, root: Path, folder: Path, netlist_files: tuple[Path, ...] = ()) -> Outcome:
    """Simulates a case in `folder`; with `netlist_files`, the netlist beside the RTL. FlowError at the first failure."""
    started = time.monotonic()
    folder.mkdir(parents=True, exist_ok=True)
    write_vectors(case, root, folder)
    compile_bench(case, root, folder, netlist_files)
    waveform = ["-fst", f"+trace={case.trace}"] if case.trace else []
    output = _run(["vvp", "-n", "bench.vvp", *waveform], folder, case.name)
    (folder / "bench.log").write_text(output, encoding="utf-8")
    return outcome(output, case, time.monotonic() - started)


def _separate_blocks(source: Path, blocks: list[str], written: Path) -> None:
    """Marks modules of a netlist as hierarchy blocks, which Verilator compiles once for all their instances."""
    text = source.read_text(encoding="utf-8")
    for block in blocks:
        text = re.sub(rf"^(module {block}\([^;]*;)", r"\1 /*verilator hier_block*/", text, flags=re.MULTILINE)
    written.write_text(text, encoding="utf-8")


def simulate_full(case: Case, technology: Technology, folder: Path) -> Outcome:
    """Simulates the netlist alone, two-state, in Verilator: for arrays too large for Icarus Verilog."""
    started = time.monotonic()
    root = technology.root
    source, *models = write_netlist(case.configuration, technology, folder, case.seed)
    written = folder / "blocks.v"
    _separate_blocks(source, re.findall(rf"^module (\w+(?:column|pair|engine){NETLIST_SUFFIX})\(",
                                        source.read_text(encoding="utf-8"), re.MULTILINE), written)
    write_vectors(case, root, folder)
    # Verilator 5.006 hands parameters of the command line to hierarchy blocks, too, so a module sets them.
    settings = ", ".join(f".{name}({value})" for name, value in bench_parameters(case, folder).items())
    (folder / "full_bench.sv").write_text(
        f"module full_bench;\n  {case.configuration.top}_bench #({settings}) u_bench ();\nendmodule\n",
        encoding="utf-8")
    shutil.rmtree(folder / "obj_dir", ignore_errors=True)
    # A few thousand clocks: compiling takes longer than running. Between hierarchy blocks every input seems to lead
    # to every combinational output, which looks like loops (UNOPTFLAT); Verilator evaluates them until they settle.
    _run(["verilator", "--cc", "--exe", "--build", "--timing", "--hierarchical", "-Wno-lint", "-Wno-style",
          "-Wno-UNOPTFLAT", "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0", "-DNETLIST",
          "-DNETLIST_ALONE", f"-I{root / 'hdl' / 'common'}", "--top-module", "full_bench", "-o", "bench",
          *map(str, [*bench_files(case, root), written, *models, folder / "full_bench.sv",
                     root / BENCHES / "full_bench_main.cpp"])], folder, case.name)
    output = _run([str(folder / "obj_dir" / "bench")], folder, case.name)
    (folder / "bench.log").write_text(output, encoding="utf-8")
    return outcome(output, case, time.monotonic() - started)


def run_all(cases: list[Case], work: Callable[[Case], Outcome], again: str, jobs: int,
            say: Callable[[str], None]) -> int:
    """Runs all cases in the given order, `jobs` at a time; returns the number of failures. `again`: command that repeats a case, with
    {name} and {seed}."""
    failed = 0
    with ProcessPoolExecutor(jobs) as pool:
        futures = {pool.submit(work, case): case for case in cases}
        for number, future in enumerate(as_completed(futures), 1):
            case = futures[future]
            try:
                found = future.result()
                say(f"[{number}/{len(cases)}] {case.title}: {found.frames} frames, {found.results} results, "
                    f"{found.clocks} clocks in {found.seconds:.0f} s")
            except FlowError as error:
                failed += 1
                say(f"[{number}/{len(cases)}] FAILED {error}")
                say(f"    again: {again.format(name=case.name, seed=case.seed)}")
    return failed
