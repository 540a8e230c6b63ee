# SPDX-License-Identifier: Apache-2.0
"""Larger and smaller arrays than the thesis's: area, clock, wires, power, clocks of a frame, and what their simulation costs (make synth-scale).

Columns are alike, so area and power of a wide array are extrapolated by a straight line through two narrower arrays with the same rows, which are
synthesised and timed like the named configurations. One whole array shows the line's error. The time of a simulation is extrapolated from strips
of columns in the same way.
"""

from __future__ import annotations

import argparse
import csv
import io
import json
import os
import re
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from . import batch, configuration, floorplan
from . import technology as technologies
from .batch import Job
from .configuration import Configuration
from .errors import FlowError
from .report_inputs import ROOT
from .run import Result, retimed
from .technology import TARGET_MHZ, Technology
from .timing import Timing

from figures.small import is_small, written_root

BUILD = ROOT / "build" / "scale"
PROGRAM = ROOT / "build" / "cpp" / "bin" / "dtof"
READOUTS = ("ezpointer", "hispointer", "poolpointer", "poolpointer_lean")
SIZES = ((64, 50), (320, 240), (640, 480), (1024, 1024))  # columns, rows
SMALL_SIZES = SIZES[:1]
PARTS = (64, 128)  # columns of the arrays that are synthesised; for poolPointer the columns of two and of four engines
WHOLE = (320, 240)  # the whole array that is synthesised beside its extrapolation
STAGE_UM = 1500.0  # of wire from the shared logic to the outermost column that one register of the broadcast crosses
MOST_STAGES = 8  # that the RTL allows
STRIP_COLUMNS = 10  # of the narrowest strip that is simulated; for poolPointer an engine's columns
STRIPS = 3  # widths that are simulated: once, twice and three times that
FRAME_RATE = 30
ACQUISITIONS = 3333  # of the sensor `thesis`
SIMULATED_ACQUISITIONS = 333
RUNS = 3  # of each simulation


@dataclass(frozen=True)
class Row:
    """One array. Areas in mm2, lengths in mm, power in mW at 330 MHz, times in s."""

    readout: str
    columns: int
    rows: int
    stages: int
    area: float
    part_columns: int  # of the widest array that was synthesised
    fmax_slow: float  # of that array
    half_width: float  # the longest way from the shared logic to a column
    power: float | None  # None: only the slow corner was timed
    frame_clocks: int
    model_s: float
    model_error: float  # of the straight line, relative; 0 if the whole array was simulated
    rtl_s: float
    rtl_error: float
    memory_mb: float  # of the widest strip
    limit: str
    start: str  # of the slowest path of the widest array that was synthesised


def stages(columns: int) -> int:
    """Registers between the shared logic and the columns."""
    return min(max(2, -(-round(columns * floorplan.PITCH_UM / 2) // round(STAGE_UM))), MOST_STAGES)


@dataclass(frozen=True)
class Whole:
    """The whole array of the size WHOLE beside its extrapolation. Areas in mm2."""

    readout: str
    extrapolated: float
    measured: float
    fmax_slow: float
    start: str  # of the slowest path
    end: str
    fmax_released: float  # if the release of the reset has as many periods as in dtof_subsystem
    start_released: str  # of the slowest path then
    end_released: str


def array(base: Configuration, columns: int, rows: int, of_columns: int = 0) -> Configuration:
    """The read-out with this size. `of_columns`: of the wider array whose part this is, and whose broadcast it has."""
    changes = {"SRAM_NUM": columns, "PIXELS_PER_SRAM": rows, "BROADCAST_STAGES": stages(of_columns or columns)}
    if base.is_pool:
        changes["ENGINE_COLUMNS"] = min(base["ENGINE_COLUMNS"], columns)
    part = f"_of_{of_columns}" if of_columns else ""
    return base.with_parameters(f"{base.name}_{columns}x{rows}{part}", **changes)


def parts(base: Configuration, columns: int, rows: int) -> list[Configuration]:
    """The arrays whose figures give those of an array; the array itself if it is not wider."""
    widths = [2 * number * base["ENGINE_COLUMNS"] for number in (1, 2)] if base.is_pool else list(PARTS)
    return [array(base, columns, rows)] if columns <= widths[-1] else [array(base, width, rows, columns) for width in widths]


def on_the_line(items: list[Configuration], values: list[float], columns: int) -> float:
    """The value of an array with this number of columns, from those of its parts."""
    if len(items) == 1:
        return values[0]
    first, last = (item["SRAM_NUM"] for item in items)
    return values[0] + (values[1] - values[0]) * (columns - first) / (last - first)


def synthesised(item: Configuration, kit: Technology, say: Callable[[str], None]) -> Result:
    """The array, mapped once: a second attempt brings some hundredths of a nanosecond, and takes as long as the first one. If a tool fails in a
    further corner, the result has the slow corner alone, without margins and power."""
    def run(job: Job) -> Result:
        return batch.run_all([job], kit, BUILD / "runs", 1, lambda _: None)[job.name]

    try:
        result = run(Job(item, most_attempts=1))
    except FlowError as error:
        say(f"{error}; goes on with the slow corner alone")
        result = run(Job(item, ("slow",), most_attempts=1))
    say(f"{item.name}: {result.total_mm2:.2f} mm2, {result.timing['slow'].fmax_mhz:.0f} MHz")
    return result


def release_periods(constraints: str) -> tuple[int, int]:
    """(periods that the release of an array's reset has in dtof_subsystem, multiplier of its hold check), from the subsystem's constraints."""
    found = [re.search(rf"^set_multicycle_path (\d+) -{kind} -through \[get_pins u_array_reset/array_rst_no\]$", constraints, re.MULTILINE)
             for kind in ("setup", "hold")]
    if not all(found):
        raise FlowError("dtof_subsystem.sdc: the release of the array's reset has no number of periods")
    setup, hold = (int(one[1]) for one in found if one)
    return setup, hold


def released_constraints(array_constraints: str, subsystem_constraints: str) -> str:
    """Constraints of an array whose reset is released as in dtof_subsystem."""
    setup, hold = release_periods(subsystem_constraints)
    return (f"{array_constraints}\nset_multicycle_path {setup} -setup -from [get_ports rst_ni]\n"
            f"set_multicycle_path {hold} -hold -from [get_ports rst_ni]\n")


def released(result: Result, kit: Technology) -> Timing:
    """Timing in the slow corner of an array that `synthesised` left, if its reset is released as in dtof_subsystem."""
    folder = BUILD / "runs" / result.configuration.name
    file = folder / "released.sdc"
    texts = ((ROOT / "constraints" / name).read_text(encoding="utf-8") for name in ("dtof.sdc", "subsystem/dtof_subsystem.sdc"))
    file.write_text(released_constraints(*texts), encoding="utf-8")
    report = retimed(result, kit, folder, kit.slow.path, kit.kit / "sram40_slow.lib", "sta_released.log", ("nominal", "closing"),
                     "reset released as in dtof_subsystem", settings={"constraints": file})
    return report.timing()


# ---- Frames and simulation ----------------------------------------------------------------------------------

def sensor(text: str, columns: int, rows: int) -> str:
    """The thesis's sensor file with another size."""
    for name, value in (("columns", columns), ("rows", rows)):
        before = next((line for line in text.splitlines() if line.startswith(f"{name} = ")), None)
        if before is None:
            raise FlowError(f"the sensor file has no line '{name} = '")
        text = text.replace(before, f"{name} = {value}", 1)
    return text


def _measured(command: list[str]) -> tuple[float, float]:
    """(seconds, largest memory in MB) of a command in a process of its own."""
    begin = time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise FlowError(f"{' '.join(command)}: {(done.stderr or done.stdout).strip().splitlines()[-1]}")
    return time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024


def _in_a_process(command: list[str]) -> tuple[float, float]:
    """As _measured. The memory of a process's children is that of the largest one so far, so each command has a parent of its own."""
    with ProcessPoolExecutor(1) as pool:
        return pool.submit(_measured, command).result()


def frame(program: Path, sensor_file: Path, readout: str, engine: str, columns: int, out: Path) -> list[str]:
    return [str(program), "frame", "--sensor", str(sensor_file), "--readout", readout, "--engine", engine, "--own-rows", "--columns",
            f"0-{columns - 1}", "--acquisitions", str(SIMULATED_ACQUISITIONS), "--table", "none", "--threads", "1", "--out", str(out)]


def strips(item: Configuration) -> list[int]:
    """Widths that are simulated, in columns: three, or fewer if the last one is the whole array."""
    unit = item["ENGINE_COLUMNS"] if item.is_pool else STRIP_COLUMNS
    return sorted({min(unit * number, item["SRAM_NUM"]) for number in range(1, STRIPS + 1)})


def extrapolated(measured: dict[int, float], columns: int) -> tuple[float, float]:
    """(value for all columns, relative error) of the line through the narrowest and the widest strip. The error is that at the strip between
    them. `measured`: values by width."""
    widths = sorted(measured)
    if widths[-1] == columns:
        return measured[columns], 0.0
    first, middle, last = widths
    slope = max((measured[last] - measured[first]) / (last - first), 0.0)  # more columns never take less time
    between = measured[first] + slope * (middle - first)
    return measured[last] + slope * (columns - last), abs(between - measured[middle]) / measured[middle]


def clocks_and_limit(program: Path, sensor_file: Path, title: str) -> tuple[int, str]:
    """(clocks of a frame, the program's sentence on what would fit, which is empty if the frame fits)."""
    done = subprocess.run([str(program), "sensor", str(sensor_file), "--frame-rate", str(FRAME_RATE), "--clock-mhz", f"{TARGET_MHZ:g}", "--json"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise FlowError(f"{sensor_file}: {done.stderr.strip()}")
    return fit(json.loads(done.stdout)["fits"], title)


def fit(text: str, title: str) -> tuple[int, str]:
    """Reads the sentences of `dtof sensor --frame-rate`."""
    line = next((line for line in text.splitlines() if line.startswith(f"{title}: ")), None)
    words = line.split() if line else []
    if "clocks," not in words:
        raise FlowError(f"dtof sensor says nothing on {title}")
    clocks = int(words[words.index("clocks,") - 1])
    return clocks, "" if line and "so that the frame fits" in line else (line or "").split("; ", 1)[-1]


def row(base: Configuration, columns: int, rows: int, results: dict[str, Result], folder: Path, text: str, say: Callable[[str], None]) -> Row:
    folder.mkdir(parents=True, exist_ok=True)
    sensor_file = folder / f"{columns}x{rows}.toml"
    sensor_file.write_text(sensor(text, columns, rows), encoding="utf-8")
    clocks, limit = clocks_and_limit(PROGRAM, sensor_file, base.title)
    found: dict[str, tuple[float, float]] = {}
    memory = 0.0
    item = array(base, columns, rows)
    for engine in ("model", "rtl"):
        seconds: dict[int, float] = {}
        for strip in strips(item):
            command = frame(PROGRAM, sensor_file, base.name.replace("_", "-"), engine, strip, folder / f"{item.name}_{engine}_{strip}")
            # The first run may build the array, which is kept. The shortest run has the least of what else the machine does.
            runs = [_in_a_process(command) for _ in range(RUNS)]
            seconds[strip] = min(time_s for time_s, _ in runs)
            memory = max(memory, *(size for _, size in runs[1:]))
        found[engine] = extrapolated(seconds, columns)
        say(f"{item.name}: {engine}: " + ", ".join(f"{strip} columns in {value:.1f} s" for strip, value in seconds.items()))
    items = parts(base, columns, rows)
    made = [results[one.name] for one in items]
    powers = [one.power.total for one in made if one.power]
    return Row(base.title, columns, rows, item["BROADCAST_STAGES"], on_the_line(items, [one.total_mm2 for one in made], columns),
               items[-1]["SRAM_NUM"], made[-1].timing["slow"].fmax_mhz, columns * floorplan.PITCH_UM / 2000,
               on_the_line(items, powers, columns) if len(powers) == len(items) else None, clocks, *found["model"], *found["rtl"], memory, limit,
               made[-1].timing["slow"].start)


def whole(base: Configuration, results: dict[str, Result], kit: Technology, say: Callable[[str], None]) -> Whole | None:
    """The array of the size WHOLE; None if a tool fails in the slow corner, too."""
    columns, rows = WHOLE
    items = parts(base, columns, rows)
    try:
        found = synthesised(array(base, columns, rows), kit, say)
    except FlowError as error:
        say(str(error))
        return None
    slow = found.timing["slow"]
    with_periods = released(found, kit)
    say(f"{found.configuration.name}: {with_periods.fmax_mhz:.0f} MHz with a release of the reset as in dtof_subsystem")
    return Whole(base.title, on_the_line(items, [results[one.name].total_mm2 for one in items], columns), found.total_mm2, slow.fmax_mhz, slow.start,
                 slow.end, with_periods.fmax_mhz, with_periods.start, with_periods.end)


# ---- Table and page -----------------------------------------------------------------------------------------

def table(rows: Iterable[Row]) -> str:
    """CSV."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([one.name for one in fields(Row)])
    writer.writerows([f"{value:.6g}" if isinstance(value, float) else "" if value is None else value for value in astuple(one)] for one in rows)
    return out.getvalue()


def _limits(rows: list[Row], wholes: list[Whole]) -> list[str]:
    """A line for each array that misses something, with what helps."""
    lines = [f"* {one.readout}, {WHOLE[0]} x {WHOLE[1]}, the whole array: {one.fmax_slow:.0f} MHz, from `{one.start}` to `{one.end}`." + (
        f" The release of the reset does not reach all columns in a period. In dtof_subsystem it has more periods (dtof_array_reset), and the array "
        f"has {one.fmax_released:.0f} MHz, from `{one.start_released}` to `{one.end_released}`." if one.start == "rst_ni" else "")
        for one in wholes if one.fmax_slow < TARGET_MHZ]
    for one in rows:
        name = f"{one.readout}, {one.columns} x {one.rows}"
        if one.fmax_slow < TARGET_MHZ:
            frames = 1e6 * one.fmax_slow / one.frame_clocks
            lines.append(f"* {name}: {one.fmax_slow:.0f} MHz even with {one.part_columns} columns, from `{one.start}`. "
                         + (f"At this clock it still has {frames:.0f} frames/s." if frames >= FRAME_RATE else
                            f"At this clock it has only {frames:.0f} frames/s: use fewer rows for each SRAM, or fewer acquisitions."))
        if 1000 * one.half_width / one.stages > STAGE_UM:
            lines.append(f"* {name}: {one.stages} registers, the most that BROADCAST_STAGES allows, leave {one.half_width / one.stages:.1f} mm of wire "
                         "between two of them: use several narrower arrays.")
        if one.limit:
            lines.append(f"* {name}: {one.limit}")
    return lines or ["No array misses the clock or the frame rate."]


def report(rows: list[Row], wholes: list[Whole]) -> str:
    def cells(one: Row) -> str:
        power = "-" if one.power is None else f"{one.power:.0f}"
        return (f"| {one.readout} | {one.columns} x {one.rows} | {one.area:.2f} | {1e6 * one.area / (one.columns * one.rows):.0f} | {one.stages} | "
                f"{one.half_width:.1f} | {one.fmax_slow:.0f} ({one.part_columns}) | {power} | {one.frame_clocks:,} | "
                f"{1e6 * TARGET_MHZ / one.frame_clocks:.0f} |")

    def simulated(one: Row) -> str:
        errors = [f"{error:.0%}" if error else "-" for error in (one.model_error, one.rtl_error)]
        return (f"| {one.readout} | {one.columns} x {one.rows} | {one.model_s:.1f} | {errors[0]} | {one.rtl_s:.1f} | {errors[1]} | "
                f"{one.memory_mb:.0f} |")

    compared = [f"| {one.readout} | {one.extrapolated:.2f} | {one.measured:.2f} | {one.extrapolated / one.measured - 1:+.1%} | {one.fmax_slow:.0f} | "
                f"`{one.start}` | {one.fmax_released:.0f} |" for one in wholes]
    return "\n".join([
        "# Other sizes of the array",
        "",
        f"From `make synth-scale`: arrays of {', '.join(f'{columns} x {lines}' for columns, lines in dict.fromkeys((one.columns, one.rows) for one in rows))} "
        "pixels (columns x rows), with the parameters of the thesis's array.",
        f"Frames have {ACQUISITIONS:,} acquisitions.",
        "",
        "## What limits them",
        "",
        *_limits(rows, wholes),
        "",
        "## Area, clock, wires, power",
        "",
        f"Columns are alike. So area and power are those of a straight line through two narrower arrays with the same rows: {PARTS[0]} and {PARTS[1]} columns, "
        "for poolPointer the columns of two and four engines. Each is mapped once.",
        "",
        "| read-out | pixels | mm2 | um2 a pixel | BROADCAST_STAGES | longest way, mm | fmax slow, MHz (of so many columns) | mW | clocks of a frame | frames/s |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
        *map(cells, rows),
        "",
        f"* BROADCAST_STAGES: registers between the shared logic and the columns, one for each {STAGE_UM / 1000:g} mm, at least 2. They change no result.",
        "* Longest way: from the shared logic in the middle to the outermost column; columns are 0.025 mm wide.",
        "* mW: at 330 MHz in the typical corner with the activity that the synthesis assumes, not that of a scene. Compare the rows with each other, and "
        "not with [power.md](power.md).",
        *(["* -: OpenSTA crashed in another corner than the slow one, so that the power is not known."] if any(one.power is None for one in rows) else []),
        *(["", f"A whole array of {WHOLE[0]} x {WHOLE[1]} pixels beside its extrapolation:", "",
           "| read-out | extrapolated, mm2 | whole, mm2 | difference | fmax slow, MHz | the slowest path begins at | fmax slow in dtof_subsystem, MHz |",
           "|---|---:|---:|---:|---:|---|---:|", *compared, "",
           "In dtof_subsystem the release of the array's reset has several periods, because the array's clock is stopped "
           "([dtof_array_reset](../docs/reference/blocks/subsystem.md#dtof_array_reset)). The registers of the commands to the columns, and of the "
           "engines' results, stand at equal distances on their way."]
          if wholes else []),
        "",
        "## Simulation",
        "",
        f"Seconds on one machine for a frame of the whole array with {SIMULATED_ACQUISITIONS} acquisitions, from strips of one, two and three times "
        f"{STRIP_COLUMNS} columns (poolPointer: an engine's "
        "columns). A straight line through the narrowest and the widest strip gives the whole array; the error is the line's at the strip between "
        f"them. Without an error the whole array was simulated. Each time is the shortest of {RUNS}, in one thread. With more threads, dtof simulates "
        "groups of columns, and a pool array's engines, at the same time.",
        "",
        "| read-out | pixels | model, s | error | RTL, s | error | memory of the widest strip, MB |",
        "|---|---:|---:|---:|---:|---:|---:|",
        *map(simulated, rows),
        ""])


def main() -> int:
    parser = argparse.ArgumentParser(description="Area, clock, power and simulation of arrays of other sizes than the thesis's.")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="arrays that are synthesised at the same time")
    arguments = parser.parse_args()
    try:
        if not PROGRAM.exists():
            raise FlowError(f"{PROGRAM}: `make` builds it")
        named = configuration.load(ROOT / "configurations.toml")
        bases = [named[readout] for readout in READOUTS]
        sizes = SMALL_SIZES if is_small() else SIZES
        items = [item for columns, rows in sizes for base in bases for item in parts(base, columns, rows)]
        kit = technologies.prepare(ROOT, BUILD / "generic40", [], more=[*items, *(array(base, *WHOLE) for base in bases)])
        with ThreadPoolExecutor(arguments.jobs) as pool:
            results = dict(zip((item.name for item in items), pool.map(lambda item: synthesised(item, kit, _say), items), strict=True))
            made = list(pool.map(lambda base: whole(base, results, kit, _say), bases if WHOLE in sizes else []))
        text = subprocess.run([str(PROGRAM), "sensor", "thesis"], capture_output=True, text=True, check=True).stdout
        found = [row(base, *size, results, BUILD / "frames", text, _say) for size in sizes for base in bases]
        reports = written_root(ROOT) / "reports"
        reports.mkdir(parents=True, exist_ok=True)
        (reports / "scale.csv").write_text(table(found), encoding="utf-8")
        (reports / "scale.md").write_text(report(found, [one for one in made if one]), encoding="utf-8")
        _say("reports/scale.md, reports/scale.csv written")
        return 0
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


def _say(line: str) -> None:
    print(line, flush=True)
