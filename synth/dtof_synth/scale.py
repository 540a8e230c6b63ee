# SPDX-License-Identifier: Apache-2.0
"""Larger and smaller arrays than the thesis's: area, clock, wires, power, clocks of a frame, and what their simulation costs (make synth-scale).

Each array is synthesised and timed like the named configurations. Simulation is measured on strips of columns and extrapolated to the whole
array by a straight line; a strip between the two ends shows the line's error.
"""

from __future__ import annotations

import argparse
import csv
import io
import json
import os
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
from .run import TARGET_MHZ, Result, Technology

from figures.small import is_small, written_root

ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "scale"
PROGRAM = ROOT / "build" / "cpp" / "bin" / "dtof"
READOUTS = ("ezpointer", "hispointer", "poolpointer", "poolpointer_lean")
SIZES = ((64, 50), (320, 240), (640, 480), (1024, 1024))  # columns, rows
SMALL_SIZES = SIZES[:1]
STAGE_UM = 1500.0  # of wire from the shared logic to the outermost column that one register of the broadcast crosses
MOST_STAGES = 8  # that the RTL allows
STRIP_COLUMNS = 10  # of the narrowest strip that is simulated; for poolPointer an engine's columns
STRIPS = 3  # widths that are simulated: once, twice and three times that
FRAME_RATE = 30
ACQUISITIONS = 3333  # of the sensor `thesis`


@dataclass(frozen=True)
class Row:
    """One array. Areas in mm2, lengths in mm, power in mW at 330 MHz, times in s."""

    readout: str
    columns: int
    rows: int
    stages: int
    area: float
    fmax_slow: float
    slack_margins: float | None  # None: only the slow corner was timed
    half_width: float  # the longest way from the shared logic to a column
    power: float | None
    frame_clocks: int
    acquisitions: int
    model_s: float
    model_error: float  # of the straight line, relative; 0 if the whole array was simulated
    rtl_s: float
    rtl_error: float
    memory_mb: float  # of the widest strip
    limit: str


def stages(columns: int) -> int:
    """Registers between the shared logic and the columns."""
    return min(max(2, -(-round(columns * floorplan.PITCH_UM / 2) // round(STAGE_UM))), MOST_STAGES)


def array(base: Configuration, columns: int, rows: int) -> Configuration:
    changes = {"SRAM_NUM": columns, "PIXELS_PER_SRAM": rows, "BROADCAST_STAGES": stages(columns)}
    if base.is_pool:
        changes["ENGINE_COLUMNS"] = min(base["ENGINE_COLUMNS"], columns)
    return base.with_parameters(f"{base.name}_{columns}x{rows}", **changes)


def arrays(named: dict[str, Configuration], sizes: Iterable[tuple[int, int]]) -> list[Configuration]:
    return [array(named[readout], columns, rows) for columns, rows in sizes for readout in READOUTS]


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
            f"0-{columns - 1}", "--table", "none", "--out", str(out)]


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
    slope = (measured[last] - measured[first]) / (last - first)
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


# ---- Table and page -----------------------------------------------------------------------------------------

def row(item: Configuration, result: Result, program: Path, folder: Path, text: str, say: Callable[[str], None]) -> Row:
    columns, rows = item["SRAM_NUM"], item["PIXELS_PER_SRAM"]
    folder.mkdir(parents=True, exist_ok=True)
    sensor_file = folder / f"{columns}x{rows}.toml"
    sensor_file.write_text(sensor(text, columns, rows), encoding="utf-8")
    option = item.name.rsplit("_", 1)[0].replace("_", "-")  # the read-out's name in `dtof`
    clocks, limit = clocks_and_limit(program, sensor_file, item.title)
    found: dict[str, tuple[float, float]] = {}
    memory = 0.0
    for engine in ("model", "rtl"):
        seconds: dict[int, float] = {}
        for strip in strips(item):
            command = frame(program, sensor_file, option, engine, strip, folder / f"{item.name}_{engine}_{strip}")
            if engine == "rtl" and not seconds:
                _in_a_process(command)  # builds the array, which is kept
            seconds[strip], size = _in_a_process(command)
            memory = max(memory, size)
        found[engine] = extrapolated(seconds, columns)
        say(f"{item.name}: {engine}: " + ", ".join(f"{strip} columns in {value:.1f} s" for strip, value in seconds.items()))
    slow = result.timing["slow"]
    margins = result.margins.get("slow")
    return Row(item.title, columns, rows, item["BROADCAST_STAGES"], result.total_mm2, slow.fmax_mhz, margins.slack if margins else None,
               columns * floorplan.PITCH_UM / 2000, result.power.total if result.power else None, clocks, ACQUISITIONS, *found["model"], *found["rtl"], memory,
               limit)


def table(rows: Iterable[Row]) -> str:
    """CSV."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([one.name for one in fields(Row)])
    writer.writerows([f"{value:.6g}" if isinstance(value, float) else "" if value is None else value for value in astuple(one)] for one in rows)
    return out.getvalue()


def _limits(rows: list[Row]) -> list[str]:
    """A line for each array that misses something, with the parameter that helps."""
    lines = []
    for one in rows:
        name = f"{one.readout}, {one.columns} x {one.rows}"
        if one.slack_margins is not None and one.slack_margins < 0:
            wires = 1000 * one.half_width / one.stages > STAGE_UM
            lines.append(f"* {name}: {one.slack_margins:.2f} ns of slack with margins, {one.fmax_slow:.0f} MHz. " + (
                "The wires of the broadcast are too long. BROADCAST_STAGES has its largest value: use several narrower arrays." if wires else
                "The wires of the broadcast are short enough; the slowest path is inside the array's logic."))
        if one.limit:
            lines.append(f"* {name}: {one.limit}")
    return lines or ["No array misses the clock or the frame rate."]


def report(rows: list[Row]) -> str:
    def cells(one: Row) -> str:
        pixels = one.columns * one.rows
        slack = "-" if one.slack_margins is None else f"{one.slack_margins:+.2f}"
        power = "-" if one.power is None else f"{one.power:.0f}"
        return (f"| {one.readout} | {one.columns} x {one.rows} | {one.area:.2f} | {1e6 * one.area / pixels:.0f} | {one.stages} | {one.half_width:.1f} | "
                f"{one.fmax_slow:.0f} | {slack} | {power} | {one.frame_clocks:,} | {1e6 * TARGET_MHZ / one.frame_clocks:.0f} |")

    def simulated(one: Row) -> str:
        errors = [f"{error:.0%}" if error else "-" for error in (one.model_error, one.rtl_error)]
        return (f"| {one.readout} | {one.columns} x {one.rows} | {one.model_s:.1f} | {errors[0]} | {one.rtl_s:.1f} | {errors[1]} | "
                f"{one.memory_mb:.0f} |")

    return "\n".join([
        "# Other sizes of the array",
        "",
        f"From `make synth-scale`: arrays of {', '.join(f'{columns} x {lines}' for columns, lines in dict.fromkeys((one.columns, one.rows) for one in rows))} "
        "pixels (columns x rows), with the parameters of the thesis's array.",
        f"Frames have {ACQUISITIONS:,} acquisitions. Each array is mapped once; `make synth` tries again where timing fails.",
        "",
        "## What limits them",
        "",
        *_limits(rows),
        "",
        "## Area, clock, wires, power",
        "",
        "| read-out | pixels | mm2 | um2 a pixel | BROADCAST_STAGES | longest way, mm | fmax slow, MHz | slack with margins, ns | mW | clocks of a frame | "
        "frames/s |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
        *map(cells, rows),
        "",
        f"* BROADCAST_STAGES: registers between the shared logic and the columns, one for each {STAGE_UM / 1000:g} mm, at least 2. They change no result.",
        "* Longest way: from the shared logic in the middle to the outermost column; columns are 0.025 mm wide.",
        "* mW: at 330 MHz in the typical corner with the activity that the synthesis assumes, not that of a scene. Compare the rows with each other, and "
        "not with [power.md](power.md).",
        *(["* -: OpenSTA crashed in another corner than the slow one, so that there are neither margins nor power."]
          if any(one.power is None for one in rows) else []),
        "",
        "## Simulation",
        "",
        f"Seconds on this machine for a frame of the whole array, from strips of one, two and three times {STRIP_COLUMNS} columns (poolPointer: an engine's "
        "columns). A straight line through the narrowest and the widest strip gives the whole array; the error is the line's at the strip between "
        "them. Without an error the whole array was simulated.",
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
        items = arrays(configuration.load(ROOT / "configurations.toml"), SMALL_SIZES if is_small() else SIZES)
        kit = technologies.prepare(ROOT, BUILD / "generic40", [], more=items)
        with ThreadPoolExecutor(arguments.jobs) as pool:
            results = dict(zip((item.name for item in items), pool.map(lambda item: synthesised(item, kit, _say), items), strict=True))
        text = subprocess.run([str(PROGRAM), "sensor", "thesis"], capture_output=True, text=True, check=True).stdout
        rows = [row(item, results[item.name], PROGRAM, BUILD / "frames", text, _say) for item in items]
        reports = written_root(ROOT) / "reports"
        reports.mkdir(parents=True, exist_ok=True)
        (reports / "scale.csv").write_text(table(rows), encoding="utf-8")
        (reports / "scale.md").write_text(report(rows), encoding="utf-8")
        _say("reports/scale.md, reports/scale.csv written")
        return 0
    except FlowError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1


def _say(line: str) -> None:
    print(line, flush=True)
