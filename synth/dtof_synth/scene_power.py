# SPDX-License-Identifier: Apache-2.0
"""make power: what an array takes on a real scene, from the transitions of a small array's netlist.

A column module with all its pixels (and one engine where there are engines) is simulated over a short frame of the
room scene; activity.py counts. The column is the one that the whole array has at the end of its run, with sized gates
and hold buffers; its energy is that of every column. The logic outside the columns has another size in the whole array,
so its energy per clock is scaled by area. The result is reported by part, for the acquisitions, for a whole frame with
its idle time, and beside what `make synth` estimates from an assumed activity.
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import threading
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from . import activity, floorplan, liberty, netlist, simulation, sram_kit, sram_model, tools, wide_words
from . import power as power_model
from .activity import OTHER, STREAMING, Activity
from .configuration import Configuration, counted_macros, memories
from .errors import FlowError, given
from .library import Library
from .mapping import efforts, elaborate, map_to_cells
from .run import FINISHED_COLUMN, Result
from .technology import TARGET_MHZ, Technology

CONFIGURATIONS = ("ezpointer", "ezpointer_one_port", "hispointer1", "hispointer", "sifh", "fifh", "threesteps", "pifh",
                  "histogram", "coarsehistogram", "poolpointer", "poolpointer_lean")
KLUX = {"day": 50.0, "dusk": 2.0}
SCENE = "room"
ACQUISITIONS = 64
FRAME_ACQUISITIONS = 33_333
FRAMES_PER_S = 30
# By configuration and light: mW while acquisitions stream in.
GOALS_MW = {"ezpointer_one_port": {"day": 70.0, "dusk": 70.0}, "hispointer": {"day": 150.0, "dusk": 150.0},
            "poolpointer": {"day": 150.0, "dusk": 90.0}, "poolpointer_lean": {"day": 100.0, "dusk": 60.0}}


@dataclass(frozen=True)
class Parts:
    """Power of the whole array in one phase, mW."""

    columns: float
    engines: float
    control: float
    sram: float
    clock: float
    leakage: float
    sram_reads: float  # in sram
    sram_saved: float = 0.0  # by write masks, not in sram

    @property
    def total(self) -> float:
        return self.columns + self.engines + self.control + self.sram + self.clock + self.leakage


@dataclass(frozen=True)
class ScenePower:
    """Power of one configuration on one scene."""

    configuration: Configuration
    light: str
    column_rate: float  # transitions of a column's data net per clock while streaming
    uniform_mw: float  # of all columns' logic, if each of its data nets had this rate: OpenSTA
    streaming: Parts
    other: Parts  # clear, scan, decision, results
    idle_mw: float  # clock with the columns' gates shut, and leakage
    leakage_mw: float  # what is left of it with the clock gated
    streaming_clocks: int  # of a frame
    other_clocks: int

    @property
    def frame_mj(self) -> float:
        return self._energy_mj(self.idle_mw)

    @property
    def gated_mean_mw(self) -> float:
        return self._energy_mj(self.leakage_mw) * FRAMES_PER_S

    @property
    def mean_mw(self) -> float:
        return self.frame_mj * FRAMES_PER_S

    def _energy_mj(self, between_frames_mw: float) -> float:
        clocks = TARGET_MHZ * 1e6 / FRAMES_PER_S
        idle = max(clocks - self.streaming_clocks - self.other_clocks, 0)
        return (self.streaming.total * self.streaming_clocks + self.other.total * self.other_clocks
                + between_frames_mw * idle) / (TARGET_MHZ * 1e6)



def small(configuration: Configuration) -> Configuration:
    """Small array of a configuration: one column module with all its pixels, one engine."""
    sizes = {"SRAM_NUM": 4, "ENGINE_COLUMNS": 4} if configuration.is_pool else {"SRAM_NUM": 1}
    return configuration.with_parameters(configuration.name, **sizes)


def _streams(ports: dict[str, int]) -> bool:
    return ports.get("tdc_ready_o") == 1 and ports.get("tdc_valid_i") == 1


def _write_verilog(design: dict, technology: Technology, folder: Path, name: str, configuration: str) -> None:
    (folder / f"{name}.json").write_text(json.dumps(design), encoding="utf-8")
    settings = folder / f"{name}_settings.tcl"
    tools.write_settings(settings, {"netlist_json": folder / f"{name}.json", "netlist": folder / f"{name}.v"})
    tools.run_yosys(technology.root / "synth" / "yosys" / "write_verilog.tcl", settings, folder / f"{name}.log",
                    configuration)


def uniform_mw(configuration: Configuration, technology: Technology, folder: Path, rate: float) -> float:
    """OpenSTA's power of all columns' logic, mW, with one toggle rate for all data nets instead of a waveform."""
    library = technology.typical
    settings = folder / "power_settings.tcl"
    tools.write_settings(settings, {
        "liberty_files": [library.path, technology.kit / "sram40_typical.lib"], "netlist": folder / "static.v",
        "top": configuration.top, "wire_load": library.wire_load, "period": f"{1000 / TARGET_MHZ:.6f}",
        "column": "u_quad" if configuration.is_pool else "u_column", "activity": f"{rate:.6f}"})
    output = tools.run_sta(technology.root / "synth" / "sta" / "power.tcl", settings, folder / "sta_power.log",
                           configuration.name)
    return power_model.data_mw(output) * configuration.column_modules


def small_case(configuration: Configuration, seed: int) -> simulation.Case:
    """Frame of the small array."""
    return simulation.Case(small(configuration), (ACQUISITIONS,), seed)


def count_activity(design: dict, case: simulation.Case, technology: Technology, folder: Path, klux: float) -> Activity:
    """Simulates the small array's netlist on the scene, compares it with RTL and model, and counts its activity. Renames the design's nets
    and modules."""
    root = technology.root
    activity.name_for_counting(design)
    files = simulation.write_simulation_netlist(design, case.configuration, technology, folder, case.seed)
    simulation.write_vectors(case, root, folder, ("--scene", SCENE, "--klux", f"{klux:g}"))
    bench = f"{case.configuration.top}_bench"
    netlist_path = f"{bench}.u_netlist"
    scopes = ", ".join([netlist_path, *(f"{netlist_path}.{path}" for path in activity.scopes_of(design) if path)])
    (folder / "activity_dump.sv").write_text(
        f'module activity_dump;\n  initial begin\n    $dumpfile("activity.vcd");\n    $dumpvars(1, {scopes});\n'
        "  end\nendmodule\n", encoding="utf-8")
    simulation.compile_bench(case, root, folder, [*files, folder / "activity_dump.sv"], ("activity_dump",))
    pipe = folder / "activity.vcd"
    pipe.unlink(missing_ok=True)
    os.mkfifo(pipe)
    # The pipe has a writer until vvp ends, so that a vvp that never opens the pipe blocks nothing.
    read_end = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    write_end = os.open(pipe, os.O_WRONLY)
    os.set_blocking(read_end, True)
    said: list[str] = []
    process = subprocess.Popen(["vvp", "-n", "bench.vvp"], cwd=folder, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True)
    output = given(process.stdout, "vvp has no output")

    def read_output() -> None:
        said.append(output.read())
        os.close(write_end)

    reader = threading.Thread(target=read_output)
    reader.start()
    counted: Activity | None = None
    try:
        with open(read_end, encoding="ascii") as lines:
            counted = activity.count(lines, design, netlist_path, _streams)
    finally:
        if process.poll() is None and not counted:
            process.kill()
        reader.join()
        output.close()
        process.wait()
        pipe.unlink(missing_ok=True)
        if process.returncode > 0:  # the waveform is incomplete, and vvp has said why
            simulation.outcome(said[0], case, 0.0)
    simulation.outcome(said[0], case, 0.0)
    return counted


def simulate(configuration: Configuration, finished_column: dict, technology: Technology, folder: Path, klux: float,
             seed: int) -> tuple[dict, Activity]:
    """Runs the small array through the flow, with the whole array's column in it; returns the design and its activity."""
    case = small_case(configuration, seed)
    elaborate(case.configuration, technology, folder)
    # A search over names of a pool read-out's engine and pair would take longer than the simulation.
    design = map_to_cells(case.configuration, technology, folder, efforts(configuration)[0])
    floorplan.finish(design, technology.slow, sram_kit.PIN_FF, configuration)
    netlist.modules(design)[netlist.column_module(design)] = finished_column
    _write_verilog(design, technology, folder, "static", case.name)
    return design, count_activity(design, case, technology, folder, klux)


def _leakage_nw(cells: dict[str, float], module: dict) -> float:
    return sum(cells.get(cell["type"], 0.0) for cell in module["cells"].values())


def _area(library: Library, module: dict) -> float:
    return sum(library.area.get(cell["type"], 0.0) for cell in module["cells"].values())


def power(configuration: Configuration, light: str, result: Result, run_folder: Path, technology: Technology, folder: Path,
          seed: int) -> ScenePower:
    """Power of one configuration in one light. `run_folder`: folder of the run with `result`. FlowError if the netlist differs from its
    RTL, or a step of the flow fails."""
    finished_column = json.loads((run_folder / FINISHED_COLUMN).read_text(encoding="utf-8"))
    design, counted = simulate(configuration, finished_column, technology, folder, KLUX[light], seed)
    library = technology.typical
    group = liberty.read(library.path)
    internal = activity.internal_energies(group, library.energy_fj)
    leakage = {cell.name: cell.number("cell_leakage_power") for cell in group.children("cell")}
    modules = configuration.column_modules
    top = netlist.modules(design)[counted.scopes[""].module]
    engine = next((scope for scope in counted.scopes.values() if scope.module.endswith("_engine_netlist")), None)
    column = next(scope for path, scope in counted.scopes.items() if path and scope is not engine)
    control_area = result.shared.area - result.engines.area
    control_scale = control_area / _area(technology.slow, top)
    engine_scale = result.engines.area / _area(technology.slow, netlist.modules(design)[engine.module]) if engine else 0
    column_leak = _leakage_nw(leakage, netlist.modules(design)[column.module]) * modules
    leak_mw = (column_leak + _leakage_nw(leakage, top) * control_scale
               + (_leakage_nw(leakage, netlist.modules(design)[engine.module]) * engine_scale if engine else 0)) * 1e-6
    leak_mw += sum(number * sram_model.macro(size).leakage for number, size in counted_macros(configuration)) * 1e-3
    clock_fj = (modules * result.column_module.clock_energy_fj + result.shared.clock_energy_fj
                + result.clock_tree.load_ff * library.voltage**2)
    clock_mw = clock_fj * TARGET_MHZ * 1e-6

    def parts(phase: str) -> Parts:
        clocks = counted.clocks.get(phase, 0)
        if not clocks:
            raise FlowError(f"{configuration.name}: the simulation has no clock of the phase {phase}")
        to_mw = TARGET_MHZ * 1e-6 / clocks

        def of(scope: activity.Scope) -> activity.Energy:
            return activity.energy(scope, phase, design, library, internal, sram_kit.PIN_FF)

        one, control = of(column), of(counted.scopes[""])
        shared = of(engine) if engine else activity.Energy()
        gated_mw = (one.gated_clock * modules + shared.gated_clock * engine_scale + control.gated_clock * control_scale) * to_mw
        def srams(of_one: float, of_control: float, of_engine: float) -> float:
            return ((of_one + of_control) * modules + of_engine * configuration.engines) * to_mw

        return Parts((one.nets + one.cells) * modules * to_mw, (shared.nets + shared.cells) * engine_scale * to_mw,
                     (control.nets + control.cells) * control_scale * to_mw,
                     srams(one.sram, control.sram, shared.sram), clock_mw + gated_mw, leak_mw,
                     srams(one.sram_reads, control.sram_reads, shared.sram_reads),
                     srams(one.sram_saved, control.sram_saved, shared.sram_saved))

    streaming_clocks = FRAME_ACQUISITIONS * configuration["PIXELS_PER_SRAM"] * configuration["SLOTS"]
    rate = activity.toggle_rate(column, STREAMING, design, counted.clocks[STREAMING])
    return ScenePower(configuration, light, rate, uniform_mw(configuration, technology, folder, rate),
                      parts(STREAMING), parts(OTHER), clock_mw + leak_mw, leak_mw, streaming_clocks,
                      counted.clocks[OTHER] + configuration.pixels)


def report(found: list[ScenePower], results: dict[str, Result], digest: str, seed: int) -> str:
    """The report in Markdown."""
    lines = ["# Power on a scene", "",
             f"Written by `make power`: the netlist of one column module, the one of [timing.md](timing.md), with "
             f"{ACQUISITIONS} acquisitions of the scene "
             f"`{SCENE}` at {', '.join(f'{klux:g} klux ({light})' for light, klux in KLUX.items())}, every transition of "
             f"every net counted, {TARGET_MHZ:g} MHz, typical corner, seed {seed}; inputs `{digest[:12]}`. Method: "
             "[docs/reference/synthesis.md](../docs/reference/synthesis.md#power-from-activity).", "",
             "mW of the whole array while acquisitions stream in. Rate: transitions of a column's data net per clock. "
             "OpenSTA: the columns' figure by the tool that knows no waveform, from this one rate for all of their data nets. "
             f"Assumed: what the same array would take if every data net toggled {power_model.ACTIVITY:g} times a clock and "
             f"{power_model.DETECTION_RATE:.0%} of the TDC slots held a detection (timing.csv).", "",
             "| read-out | light | rate | columns | OpenSTA | engines | control | SRAM | clock | leakage | total | assumed |",
             "|---|---|" + "---:|" * 10]
    for one in found:
        part = one.streaming
        assumed = given(results[one.configuration.name].power, f"{one.configuration.name} has no power")
        lines.append(f"| {one.configuration.title} | {one.light} | {one.column_rate:.2f} | {part.columns:.1f} | "
                     f"{one.uniform_mw:.1f} | {part.engines:.1f} | {part.control:.1f} | {part.sram:.1f} | {part.clock:.1f} | "
                     f"{part.leakage:.1f} | {part.total:.1f} | {assumed.total:.1f} |")
    lines += ["", f"A frame of {FRAME_ACQUISITIONS} acquisitions, {FRAMES_PER_S} frames/s. Other: clear, scan, decision and "
              "results. Idle: leakage and what the clock tree feeds of a bare array; in `dtof_subsystem` the array's clock rests "
              "between frames, and leakage is left (gated).", "",
              "| read-out | light | streaming mW | other mW | idle mW | gated | streaming | other | frame mJ | pixel nJ | mean mW | "
              "gated |", "|---|---|" + "---:|" * 10]
    for one in found:
        frame = TARGET_MHZ * 1e6 / FRAMES_PER_S
        lines.append(f"| {one.configuration.title} | {one.light} | {one.streaming.total:.1f} | {one.other.total:.1f} | "
                     f"{one.idle_mw:.1f} | {one.leakage_mw:.1f} | {one.streaming_clocks / frame:.0%} | {one.other_clocks / frame:.1%} | "
                     f"{one.frame_mj:.2f} | {one.frame_mj * 1e6 / one.configuration.pixels:.0f} | {one.mean_mw:.1f} | "
                     f"{one.gated_mean_mw:.1f} |")
    lines += ["", "## Goals", "", "While acquisitions stream in.", "", "| goal | here | met |", "|---|---:|---:|"]
    for one in found:
        limit = GOALS_MW.get(one.configuration.name, {}).get(one.light)
        if limit is not None:
            lines.append(f"| {one.configuration.title}, {one.light}: at most {limit:g} mW | {one.streaming.total:.1f} mW | "
                         f"{'yes' if one.streaming.total <= limit else '**no**'} |")
    lines += mask_lines(found) + wide_word_lines(found)
    return "\n".join([*lines, ""])


def mask_lines(found: list[ScenePower]) -> list[str]:
    """Lines on what the SRAMs' write masks save."""
    masked = [one for one in found if one.streaming.sram_saved > 0]
    if not masked:
        return []
    lines = ["", "## Write masks", "",
             "An SRAM of a pool read-out writes the pixels of its word that changed. A write with a mask costs a read, and for each part that it "
             "writes the part's share of what a whole write costs more than a read; this is an assumption about the macro. mW of the array with "
             "macros that write the whole word instead:", "",
             "| read-out | light | SRAM | total | SRAM without masks | total then |", "|---|---|" + "---:|" * 4]
    for one in masked:
        part = one.streaming
        lines.append(f"| {one.configuration.title} | {one.light} | {part.sram:.1f} | {part.total:.1f} | {part.sram + part.sram_saved:.1f} | "
                     f"{part.total + part.sram_saved:.1f} |")
    return lines


def wide_word_lines(found: list[ScenePower]) -> list[str]:
    """Lines on the power of arrays with wide words if the energy of a read grew with the bits as in CACTI."""
    bits = {one.configuration.name: max(size.bits for size in memories(one.configuration).values()) for one in found}
    wide = [one for one in found if bits[one.configuration.name] > wide_words.FITTED_BITS]
    if not wide:
        return []
    lines = ["", "## Wide words", "",
             f"The energy of a read is extrapolated for words of more than {wide_words.FITTED_BITS} bits, linearly in the bits. "
             "CACTI's grows faster ([sram.md](sram.md#words-of-96-to-256-bits)). mW of the array if that held for these words:", "",
             "| read-out | light | bits | reads | total | reads cost | total then |", "|---|---|" + "---:|" * 5]
    for one in wide:
        factor = wide_words.read_factor(bits[one.configuration.name])
        part = one.streaming
        lines.append(f"| {one.configuration.title} | {one.light} | {bits[one.configuration.name]} | {part.sram_reads:.1f} | "
                     f"{part.total:.1f} | x {factor:.2f} | {part.total + (factor - 1) * part.sram_reads:.1f} |")
    return lines


def write_csv(path: Path, found: list[ScenePower]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["configuration", "light", "klux", "column_rate", "opensta_columns_mw", "phase", "columns_mw", "engines_mw", "control_mw",
                         "sram_mw", "sram_reads_mw", "clock_mw", "leakage_mw", "total_mw", "clocks_of_a_frame", "frame_mj"])
        for one in found:
            for phase, part, clocks in ((STREAMING, one.streaming, one.streaming_clocks),
                                        (OTHER, one.other, one.other_clocks)):
                figures = (part.columns, part.engines, part.control, part.sram, part.sram_reads, part.clock, part.leakage,
                           part.total)
                writer.writerow([one.configuration.name, one.light, f"{KLUX[one.light]:g}", f"{one.column_rate:.4f}",
                                 f"{one.uniform_mw:.3f}", phase, *(f"{figure:.3f}" for figure in figures), clocks, f"{one.frame_mj:.4f}"])


def run(chosen: list[Configuration], results: dict[str, Result], run_folders: Path, technology: Technology, folder: Path,
        seed: int, workers: int, say: Callable[[str], None]) -> list[ScenePower]:
    """Power of all chosen configurations in all lights, `workers` at a time, the longest first. The first failure stops all."""
    tasks = [(configuration, light) for configuration in chosen for light in KLUX]
    found: dict[tuple[str, str], ScenePower] = {}
    with ProcessPoolExecutor(workers) as pool:
        futures = {pool.submit(power, configuration, light, results[configuration.name], run_folders / configuration.name,
                               technology, folder / f"{configuration.name}_{light}", seed): (configuration.name, light)
                   for configuration, light in sorted(tasks, key=lambda task: simulation.expected_rank(task[0]))}
        try:
            for future in as_completed(futures):
                name, light = futures[future]
                found[(name, light)] = future.result()
                say(f"[{len(found)}/{len(tasks)}] {name}, {light}: {found[(name, light)].streaming.total:.1f} mW")
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return [found[(configuration.name, light)] for configuration, light in tasks]
