#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The project's read-outs and their rivals: accuracy over memory, area and the host's work, and which suits which sensor.

`rivals.py DTOF_STUDY --out FOLDER OPTION ...`: runs `DTOF_STUDY rivals OPTION ...` with the bits of the project's read-outs
as synthesis reports them (reports/area.csv), then the sensors of SENSORS on fewer scenes in folders of their own, and writes
the report and its pictures to FOLDER. A run that ended well with the same program and the same options is not made again.
`rivals.py --report FOLDER`: writes report and pictures again from the tables in FOLDER.
"""

import csv
import hashlib
import math
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import plot_style
from dtof_synth import program, rival_area
from figures.small import is_small

ROOT = Path(__file__).resolve().parent.parent
AREA = ROOT / "reports" / "area.csv"
WIDTH, HEIGHT = 1000, 640
LEFT, RIGHT, TOP, BOTTOM = 75, 330, 45, 60
FONT = 13
RIVAL_COLOUR = "#6b6b6b"
RIVAL_MARKER = 7  # gnuplot's filled circle, small
SHARE = "above_3_percent"
LEAST_PERCENT = 0.02  # shares below are drawn here: a logarithmic axis has no zero
COLUMNS, ROWS = 200, 160  # of the areas
READOUT_OPERATIONS = 1  # of the host: the look-up table alone, which no estimator goes without
BUDGETS = (1.0, 1.5, 5.0, math.inf)  # mm2
INDOORS, SUN = "2", "50"  # klux
RUN_MARK = "run.sha256"  # in the folder of a run that ended well


@dataclass(frozen=True)
class Sensor:
    title: str
    name: str  # a preset, or a file below studies/
    distance_scale: float  # of the scenes, which are made for 45 ns


SENSORS = (Sensor("phone, 200 x 160", "phone", 1.0), Sensor("robot, 80 x 64", "rivals/robot.toml", 2.0),
           Sensor("car-like, 320 x 120", "rivals/car.toml", 8.9),
           Sensor("small array, 64 x 50", "rivals/small.toml", 1.0))
THESIS = "thesis, 200 x 160"
SENSOR_OPTIONS = ("--scene", "room", "planes", "clutter", "poles", "--klux", INDOORS, SUN, "--pooled", "--seeds", "2" if is_small() else "4",
                  "--columns", "1" if is_small() else "10")


@dataclass
class Point:
    title: str
    kind: str  # read-out, rival, reference
    bits: float | None
    percent: float
    low: float
    high: float
    percent_10: float = math.nan
    mm2: float | None = None
    operations: int | None = None  # of the host, per pixel


@dataclass(frozen=True)
class Axis:
    """Quantity on the horizontal axis of a picture."""

    name: str  # in the file's name
    label: str
    value: Callable[[Point], float | None]


AXES = (Axis("bits", "memory, bits per pixel", lambda point: point.bits),
        Axis("mm2", f"area of {COLUMNS} x {ROWS} pixels, mm2", lambda point: point.mm2),
        Axis("host", "operations of the host per pixel, look-up table apart", lambda point: point.operations))


def known_bits(area: Path) -> dict[str, str]:
    """Bits per pixel by the read-outs' command-line names."""
    if not area.is_file():
        return {}
    with area.open(newline="", encoding="utf-8") as file:
        return {row["configuration"].replace("_", "-"): row["bits_per_pixel"] for row in csv.DictReader(file)
                if row["configuration"].replace("_", "-") == row["readout"].replace("_", "-")}


def known_areas(area: Path) -> dict[str, float]:
    """Area of the thesis's array in mm2, by the read-outs' titles."""
    known = rival_area.load(ROOT / "configurations.toml")
    with area.open(newline="", encoding="utf-8") as file:
        return {known[row["configuration"]].title: float(row["total_mm2"]) for row in csv.DictReader(file)
                if row["configuration"] in known and not row["variant_of"] and int(row["columns"]) == COLUMNS
                and known[row["configuration"]]["PIXELS_PER_SRAM"] == ROWS}


def estimated(hardware: Path) -> dict[str, tuple[float, int]]:
    """(mm2, host's operations) for each row of a rival, by title. Pooling adds work for the host only."""
    base = rival_area.Base.read(AREA)
    found = {}
    with hardware.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            parts = rival_area.Hardware(*(int(row[name]) for name in ("words", "word_bits", "adder_bits", "table_bits")))
            mm2 = rival_area.array_mm2(base, parts, COLUMNS, ROWS)
            alone = int(row["host_operations"])
            found[row["rival"]] = (mm2, alone)
            found[row["rival"] + ", pooled"] = (mm2, alone + int(row["pooling_operations"]))
    return found


def points_of(path: Path) -> dict[str, list[Point]]:
    """Points by light level, over all scenes with depth."""
    areas = known_areas(AREA) if AREA.is_file() else {}
    hardware = path.parent / "rival_hardware.csv"
    rivals = estimated(hardware) if hardware.is_file() else {}
    lights: dict[str, list[Point]] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["scene"] == "all":
                title, kind = row["estimator"], row["kind"]
                low, high = (100 * float(row[SHARE + part]) for part in ("_low", "_high"))
                own = (areas.get(title), READOUT_OPERATIONS if kind == "read-out" else None)
                mm2, operations = rivals.get(title, own) if kind == "rival" else own
                lights.setdefault(row["klux"], []).append(
                    Point(title, kind, float(row["bits_per_pixel"]) if row["bits_per_pixel"] else None,
                          100 * float(row[SHARE]), low, high, 100 * float(row.get("above_10_percent") or "nan"), mm2,
                          operations))
    return lights


def front(points: Iterable[Point], value: Callable[[Point], float | None] = AXES[0].value) -> list[Point]:
    """Points of the front: no other point is better with as little of the axis's quantity."""
    best, found = math.inf, []
    for point in sorted((p for p in points if value(p)), key=lambda p: (value(p), p.percent)):
        if point.percent < best:
            best = point.percent
            found.append(point)
    return found


def script(klux: str, points: list[Point], axis: Axis, output: Path) -> str:
    """Gnuplot script with numbered points and a legend of the numbers beside them."""
    styles = plot_style.load()
    shown = sorted((p for p in points if axis.value(p)), key=lambda p: (axis.value(p) or 0, p.percent))
    level = lambda percent: max(percent, LEAST_PERCENT)  # noqa: E731
    values = [value for p in shown if (value := axis.value(p))]
    lines = [f"set terminal svg size {WIDTH},{HEIGHT} font 'sans,{FONT}' background '#ffffff'", f"set output '{output}'",
             "set logscale xy", "set grid lc rgb '#dddddd'", "unset key",
             f"set lmargin at screen {LEFT / WIDTH}", f"set rmargin at screen {1 - RIGHT / WIDTH}",
             f"set tmargin at screen {1 - TOP / HEIGHT}", f"set bmargin at screen {BOTTOM / HEIGHT}",
             f"set title 'Pixels off by more than 3 %, in %: all scenes but the flats, {klux} klux' offset 0,-0.4",
             f"set xlabel '{axis.label}'", "set ylabel 'pixels above 3 %, %'",
             f"set xrange [{min(values) * 0.8}:{max(values) * 1.25}]",
             f"set yrange [{0.7 * min(level(p.percent) for p in points)}:{min(100, 1.4 * max(level(p.high) for p in points))}]"]
    best = front(points, axis.value)
    lines += ["$front << END"] + [f"{axis.value(p)} {level(p.percent)}" for p in best] + ["END"]
    plots = ["$front with steps lc rgb '#bbbbbb' notitle"]
    height = (HEIGHT - TOP - BOTTOM) / max(len(shown), 1)
    for number, p in enumerate(shown, 1):
        if p.kind == "rival":
            colour, marker, size = RIVAL_COLOUR, RIVAL_MARKER, 0.5
        else:
            style = plot_style.style(p.title, styles)
            colour, marker, size = style.colour, style.marker, 1.1
        x = axis.value(p)
        lines += [f"$p{number} << END", f"{x} {level(p.percent)} {level(p.low)} {level(p.high)}", "END"]
        plots.append(f"$p{number} with yerrorbars pt {marker} ps {size} lc rgb '{colour}' notitle")
        weight = "{/:Bold %d}" if p in best else "%d"
        lines.append(f"set label '{weight % number}' at {x}, {level(p.percent)} offset 0.7,0.4 tc rgb '{colour}' font ',10'")
        lines.append(f"set label '{weight % number}  {p.title}, {x:.4g}' at screen {1 - (RIGHT - 15) / WIDTH}, "
                     f"{1 - (TOP + (number - 0.5) * height) / HEIGHT} left tc rgb '{colour}' font ',{min(11, height * 0.75):.1f}'")
    for p in points:
        if p.kind == "reference" and p.bits is None and "filter" in p.title:
            style = plot_style.style(p.title, styles)
            lines.append(f"set arrow from graph 0, first {level(p.percent)} to graph 1, first {level(p.percent)} nohead "
                         f"dt {style.dash} lc rgb '{style.colour}'")
            lines.append(f"set label '{p.title}' at graph 0.98, first {level(p.percent)} right offset 0,0.5 "
                         f"tc rgb '{style.colour}' font ',10'")
    lines.append("plot " + ", ".join(plots))
    return "\n".join(lines) + "\nset output\n"


def draw(folder: Path, lights: dict[str, list[Point]]) -> None:
    for klux, points in lights.items():
        for axis in AXES:
            if not any(axis.value(p) for p in points):
                continue
            with tempfile.TemporaryDirectory() as temporary:
                drawn = Path(temporary) / "plot.svg"
                result = subprocess.run(["gnuplot"], input=script(klux, points, axis, drawn), text=True, capture_output=True,
                                        check=False)
                if result.returncode != 0 or not drawn.is_file():
                    raise SystemExit(f"error: gnuplot failed: {result.stderr.strip()}")
                (folder / f"rivals_{axis.name}_{klux}klux.svg").write_text(drawn.read_text(encoding="utf-8"),
                                                                            encoding="utf-8")


def share(point: Point) -> str:
    return f"{point.percent:.2f} +-{(point.high - point.low) / 2:.2f}"


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    header = list(header)
    lines = [header, ["---"] + ["---:"] * (len(header) - 1), *(list(row) for row in rows)]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def cost_section(lights: dict[str, list[Point]]) -> str:
    beside = rival_area.beside_synthesis(AREA, ROOT / "configurations.toml")
    ratios = [entry.estimated_mm2 / entry.synthesised_mm2 for entry in beside]
    text = [f"## Area and host work\n\nmm2: area of {COLUMNS} x {ROWS} pixels. For the project's read-outs it is the synthesised area "
            "(reports/area.md). For rivals it is an estimate from the SRAM model and a rule for logic "
            "(synth/dtof_synth/rival_area.py); control and pipelines of rivals are not counted. For the thesis's read-outs, this rule gives "
            f"{min(ratios):.2f} to {max(ratios):.2f} times the synthesised area. Host operations: multiply-adds and comparisons per "
            "pixel, without the look-up table that every read-out needs; 1 stands for none. Bold: no row with at most this area has fewer "
            "errors.\n\n" + table(("read-out", "estimated mm2", "synthesised mm2", "ratio"),
                                  ((entry.title, f"{entry.estimated_mm2:.2f}", f"{entry.synthesised_mm2:.2f}",
                                    f"{entry.estimated_mm2 / entry.synthesised_mm2:.2f}") for entry in beside))]
    for klux, points in lights.items():
        best = front(points, AXES[1].value)
        rows = []
        for p in sorted((p for p in points if p.mm2), key=lambda p: (p.mm2, p.percent)):
            title = f"**{p.title}**" if p in best else p.title
            rows.append((title, f"{p.mm2:.2f}", f"{p.bits:g}" if p.bits else "-", f"{p.operations}", share(p),
                         f"{p.percent_10:.2f}"))
        text.append(f"### {klux} klux\n\n" + "".join(f"![Accuracy over {axis.label}, {klux} klux]"
                                                      f"(rivals_{axis.name}_{klux}klux.svg)\n\n" for axis in AXES)
                    + table(("estimator", "mm2", "bits per pixel", "host operations", "above 3 %, %", "above 10 %, %"), rows))
    return "\n".join(text)


def best_within(points: Iterable[Point], budget: float) -> Point | None:
    """Point with the fewest errors within the budget; of equal points the smallest, then the one with least work."""
    within = [p for p in points if p.mm2 and p.mm2 <= budget]
    return min(within, key=lambda p: (p.percent, p.mm2 or 0, p.operations or 0)) if within else None


def sensor_section(sensors: dict[str, dict[str, list[Point]]]) -> str:
    rows = []
    chosen: dict[str, int] = {}
    for title, lights in sensors.items():
        for klux, name in ((INDOORS, "indoors"), (SUN, "in the sun")):
            cells = []
            for budget in BUDGETS:
                point = best_within(lights.get(klux, []), budget)
                cells.append(f"{point.title}: {share(point)} ({point.mm2:.2f} mm2)" if point else "-")
                if point:
                    chosen[point.title] = chosen.get(point.title, 0) + 1
            rows.append((title, f"{name}, {klux} klux", *cells))
    limits = [f"at most {budget:g} mm2" if math.isfinite(budget) else "any area" for budget in BUDGETS]
    ranking = sorted(chosen.items(), key=lambda entry: -entry[1])
    return ("## Which read-out for which sensor\n\nEach cell has the read-out with the fewest pixels above 3 % within a limit of area, "
            "and its share in per cent +- half of the interval, over all scenes except flat targets. The area is that of the thesis's "
            "array of 32,000 pixels, whatever the sensor's size. \"pooled\": the host pools the pixels. The sensors are those of "
            "`studies/rivals/` and the presets; the scenes are scaled to the sensors' ranges.\n\n" + table(("sensor", "light", *limits), rows)
            + f"\nNumber of cells in which a read-out is the best one, of {sum(chosen.values())} in all: "
            + ", ".join(f"{title} {count}" for title, count in ranking) + ".\n")


def folder_of(sensor: Sensor) -> str:
    return Path(sensor.name).stem


def argument_of(sensor: Sensor) -> str:
    """What --sensor takes."""
    return str(ROOT / "studies" / sensor.name) if sensor.name.endswith(".toml") else sensor.name


def report(folder: Path) -> None:
    lights = points_of(folder / "rivals.csv")
    draw(folder, lights)
    sensors = {THESIS: lights}
    for sensor in SENSORS:
        tables = folder / folder_of(sensor) / "rivals.csv"
        if tables.is_file():
            sensors[sensor.title] = points_of(tables)
    text = (folder / "rivals.md").read_text(encoding="utf-8")
    own = [sensor_section(sensors), cost_section(lights)] if AREA.is_file() else []
    first_light = text.find("\n## ", text.index("## Beside each other") + 1) + 1
    (folder / "report.md").write_text(text[:first_light] + "".join(part + "\n" for part in own) + text[first_light:],
                                      encoding="utf-8")


def run(study: str, folder: Path, options: list[str]) -> None:
    """Runs the study with its files in `folder`, unless they are those of the same program and options."""
    bits = [f"{name}={value}" for name, value in known_bits(AREA).items()]
    command = [study, "rivals", "--out", str(folder), *options, *(["--bits", *bits] if bits else [])]
    named = [option.rpartition("=")[2] for option in options]  # FILE, or NAME=FILE
    files = [Path(name).read_bytes() for name in named if Path(name).is_file()]
    digest = hashlib.sha256(b"\0".join([Path(study).read_bytes(), *files, *map(str.encode, command)])).hexdigest()
    mark = folder / RUN_MARK
    if mark.is_file() and mark.read_text(encoding="utf-8") == digest and (folder / "rivals.csv").is_file():
        print(f"{folder}: from an earlier run of the same program")
        return
    mark.unlink(missing_ok=True)
    result = subprocess.run(command, check=False)
    if result.returncode != 0:
        raise SystemExit(result.returncode)
    mark.write_text(digest, encoding="utf-8")


def main() -> None:
    if len(sys.argv) == 3 and sys.argv[1] == "--report":
        report(Path(sys.argv[2]))
        return
    if len(sys.argv) < 4 or sys.argv[2] != "--out":
        raise SystemExit(f"usage: {__doc__}")
    study, folder = sys.argv[1], Path(sys.argv[3])
    run(study, folder, sys.argv[4:])
    for sensor in SENSORS:
        run(study, folder / folder_of(sensor), ["--sensor", argument_of(sensor), "--distance-scale", f"{sensor.distance_scale:g}",
                                                *SENSOR_OPTIONS])
    report(folder)
    print(f"{folder / 'report.md'} written")


if __name__ == "__main__":
    program.run(main)
