#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Area against accuracy of every read-out and variant, and poolPointer's goals beside what was measured.

Areas, clock and bits are those of `make synth` (reports/area.csv, timing.csv), accuracies those of `dtof-study scenes`
(reports/scenes.csv, and scenes_variants.csv for variants that change results). Writes reports/pareto.md, .csv, .svg
(pixels off by more than 3 %) and pareto_rmse.svg. Configurations without an area are named as missing.
"""

import csv
import math
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import plot_style
from dtof_synth import program
from dtof_synth.configuration import Configuration, load
from dtof_synth.goals import ARRAY_MM2
from figures.small import written_root

ROOT = Path(__file__).resolve().parent.parent
REPORTS = ROOT / "reports"
WRITTEN = written_root(ROOT) / "reports"

POOL_CONFIGURATIONS = {"poolpointer": "poolPointer", "poolpointer_lean": "poolPointer lean"}
PRESET = "thesis"
LIGHTS = {"indoor": "14", "outdoor": "50"}
ARRAY_PIXELS = 32000
# Estimators of dtof-study scenes on full histograms, which no chip could hold: the first is no bound for read-outs that pool.
REFERENCES = ("matched filter (single pixel)", "pooled matched filter")
# Share above 3 % and relative rmse of a reference, by its name and the light.
References = dict[str, dict[str, tuple[float, float]]]


def rows(name: str) -> list[dict[str, str]]:
    path = REPORTS / name
    if not path.is_file():
        raise SystemExit(f"error: reports/{name} is missing: run `make synth` and `make scenes` first")
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class Scenes:
    """Figures of estimators by scene; figures over several scenes are weighted by pixels."""

    def __init__(self) -> None:
        self.rows: dict[tuple[str, str, str, str], dict[str, str]] = {}
        for name in ("scenes_variants.csv", "scenes.csv"):
            for row in rows(name):
                self.rows[row["sensor"], row["klux"], row["scene"], row["estimator"]] = row

    def figure(self, klux: str, scene: str, estimator: str, column: str, preset: str = PRESET) -> float | None:
        row = self.rows.get((preset, klux, scene, estimator))
        return float(row[column]) if row and row[column] else None

    def names(self, flats: bool) -> list[str]:
        found = dict.fromkeys(key[2] for key in self.rows if key[0] == PRESET)
        return [name for name in found if name.startswith("flat") == flats]

    def overall(self, klux: str, estimator: str) -> tuple[float, float] | None:
        """Share of errors above 3 % and relative rmse over all scenes except the flat ones."""
        names = self.names(flats=False)
        chosen = [row for name in names if (row := self.rows.get((PRESET, klux, name, estimator)))]
        if not chosen or len(chosen) < len(names):
            return None
        pixels = sum(int(row["pixels"]) for row in chosen)
        above = sum(int(row["pixels"]) * float(row["above_3_percent"]) for row in chosen)
        square = sum(int(row["pixels"]) * float(row["relative_rmse"]) ** 2 for row in chosen)
        return above / pixels, math.sqrt(square / pixels)


def estimator_title(configuration: Configuration, base: Configuration) -> str:
    """Title as in `dtof-study scenes`: the read-out's title followed by the parameters that change results."""
    title = base.title
    for name in ("COUNT_WIDTH", "FRACTION_BITS", "WINDOW_CENTRED"):
        if configuration.parameters.get(name) != base.parameters.get(name):
            title += f" {name}={configuration[name]}"
    return title


@dataclass
class Point:
    title: str
    family: str  # title of the read-out that it is or is a variant of
    variant: bool
    mm2: float
    bits: str
    thesis_mm2: float | None
    accuracy: dict[str, tuple[float, float]]  # share above 3 %, relative rmse


def collect(scenes: Scenes) -> tuple[list[Point], list[str]]:
    """Points of the diagram, and the names of configurations without figures."""
    configurations = load(ROOT / "configurations.toml")
    area = {row["configuration"]: row for row in rows("area.csv")}
    missing = [name for name in POOL_CONFIGURATIONS if name not in area]
    points = []
    for name, configuration in configurations.items():
        base = configurations[configuration.variant_of or name]
        estimator = POOL_CONFIGURATIONS.get(name) or estimator_title(configuration, base)
        if name not in area:
            missing.append(name)
            continue
        accuracy = {light: found for light, klux in LIGHTS.items() if (found := scenes.overall(klux, estimator))}
        if len(accuracy) < len(LIGHTS):
            missing.append(f"{name} (accuracy of {estimator})")
            continue
        row = area[name]
        scale = ARRAY_PIXELS / (int(row["columns"]) * configuration["PIXELS_PER_SRAM"])
        points.append(Point(
            title=configuration.title + (", area scaled to the array" if scale != 1 else ""),
            family=POOL_CONFIGURATIONS.get(name) or base.title, variant=bool(configuration.variant_of),
            mm2=float(row["total_mm2"]) * scale, bits=row["bits_per_pixel"],
            thesis_mm2=float(row["thesis_mm2"]) if row["thesis_mm2"] else None, accuracy=accuracy))
    return points, list(dict.fromkeys(missing))


# ---- Goals -----------------------------------------------------------------------------------------------

def goals(scenes: Scenes) -> list[tuple[str, str, str]]:
    """(goal, measured value, whether it is met) for each goal."""
    table = []
    area = {row["configuration"]: row for row in rows("area.csv")}
    slow = {row["configuration"]: row for row in rows("timing.csv") if row["corner"] == "slow"}

    def add(goal: str, measured: str, met: bool | None) -> None:
        table.append((goal, measured, "-" if met is None else "yes" if met else "**no**"))

    def ratio(goal: str, klux: str, names: list[str], column: str, limit: float) -> None:
        parts, met = [], True
        for scene in names:
            pool = scenes.figure(klux, scene, "poolPointer", column)
            single = scenes.figure(klux, scene, "hisPointer", column)
            if pool is None or single is None:
                parts.append(f"{scene} not measured")
                met = False
                continue
            value = pool / single if single > 0 else (0.0 if pool == 0 else math.inf)
            met = met and value <= limit
            parts.append(f"{scene} {value:.2f} ({100 * pool:.2f} / {100 * single:.2f} %)")
        add(goal, "; ".join(parts), met)

    designed = ["room", "planes", "disparity map"]
    held = ["held planes", "held disparity map", "held surface"]
    for title, names in (("", designed), ("; held scenes", held)):
        ratio(f"50 klux, boxes, planes, depth maps{title}: pixels above 3 %, at most 1/3 of hisPointer's", "50", names,
              "above_3_percent", 1 / 3)
        ratio(f"50 klux, the same{title}: outliers above 10 %, at most 1/5", "50", names, "above_10_percent", 1 / 5)

    def flats(goal: str, klux: str, metres: list[str], limit: float, column: str, preset: str = PRESET,
              over_bound: bool = False) -> None:
        parts, met = [], True
        for distance in metres:
            value = scenes.figure(klux, f"flat {distance} m", "poolPointer", column, preset)
            bound = scenes.figure(klux, f"flat {distance} m", "poolPointer", "relative_bound", preset) if over_bound else 1.0
            if value is None or bound is None:
                parts.append(f"{distance} m not measured")
                met = False
                continue
            value /= bound
            met = met and value <= limit
            parts.append(f"{distance} m {value:.2f}" if over_bound else f"{distance} m {100 * value:.2f} %")
        add(goal, "; ".join(parts), met)

    flats("50 klux, flats from 0.5 to 4 m: rmse at most 3 %", "50", ["0.5", "1", "2", "3", "4"], 0.03, "relative_rmse")
    flats("14 klux, flats to 5 m: rmse at most 3 %", "14", ["0.5", "1", "2", "3", "4", "5"], 0.03, "relative_rmse")
    flats("14 klux, flats from 1 to 4 m: rmse at most 1.5 times the single pixel's bound", "14", ["1", "2", "3", "4"], 1.5,
          "relative_rmse", over_bound=True)
    flats("14 klux, flat at 0.2 m: within 2 % (rmse)", "14", ["0.2"], 0.02, "relative_rmse")
    flats("preset `phone`, 14 klux, usable to 2 m: rmse at most 3 %", "14", ["0.5", "1", "2"], 0.03, "relative_rmse",
          preset="phone")
    for klux in ("2", "14"):
        ratio(f"{klux} klux, clutter: outliers above 10 %, no more than hisPointer's", klux, ["clutter", "held clutter"],
              "above_10_percent", 1.0)
    pool, single = (scenes.figure("14", "isolated", name, "single_above_10_percent") for name in
                    ("poolPointer", "hisPointer"))
    isolated = "14 klux, isolated pixels at 3 m: kept as often as by hisPointer"
    if pool is None or single is None:
        add(isolated, "not measured", False)
    else:
        add(isolated, f"lost: {100 * pool:.2f} % (hisPointer {100 * single:.2f} %)", pool <= single)
    for name, bits, aim in (("poolpointer", 40, " (aim 1.15)"), ("poolpointer_lean", 20, "")):
        title = POOL_CONFIGURATIONS[name]
        if name not in area:
            add(f"{title}: memory, area, clock", "not in reports/area.csv", None)
            continue
        measured = float(area[name]["bits_per_pixel"])
        add(f"{title}: at most {bits} bits a pixel", f"{measured:g}", measured <= bits)
        measured = float(area[name]["total_mm2"])
        limit = ARRAY_MM2[name]
        add(f"{title}: at most {limit:g} mm2{aim}", f"{measured:.3f} mm2", measured <= limit)
        measured = float(slow[name]["fmax_mhz"])
        add(f"{title}: 330 MHz in the slow corner", f"{measured:.0f} MHz", measured >= 330)
    return table


# ---- Plot ------------------------------------------------------------------------------------------------

WIDTH, HEIGHT = 1240, 600
LEFT, RIGHT, TOP, BOTTOM = 75, 20, 45, 60
FONT, LETTER, LINE = 13, 7.6, 16
LEGEND = "small: variants; crosses: area of the thesis"
THESIS_MARKER = 1  # that of a reference, which this picture draws as a line


class Panel:
    """Logarithmic axes of one of two panels side by side, in pixels from the upper left corner."""

    def __init__(self, index: int, x_range: tuple[float, float], y_range: tuple[float, float]) -> None:
        self.x0 = index * WIDTH / 2 + LEFT
        self.x1 = (index + 1) * WIDTH / 2 - RIGHT
        self.x_range, self.y_range = x_range, y_range

    def at(self, x: float, y: float) -> tuple[float, float]:
        def share(value: float, low_high: tuple[float, float]) -> float:
            low, high = (math.log(v) for v in low_high)
            return (math.log(value) - low) / (high - low)
        return (self.x0 + share(x, self.x_range) * (self.x1 - self.x0),
                HEIGHT - BOTTOM - share(y, self.y_range) * (HEIGHT - TOP - BOTTOM))


def place_labels(panel: Panel, labels: list[tuple[str, float, float]],
                 marks: list[tuple[float, float]]) -> list[tuple[str, float, float, bool]]:
    """Positions (left edge, middle) at which the labels cover neither marks nor each other, and whether a label needs a line to its
    mark."""
    taken = [(x - 7, y - 7, x + 7, y + 7) for x, y in marks]
    placed = []
    for text, x, y in sorted(labels, key=lambda label: label[2]):
        width = LETTER * len(text)
        candidates = []
        for distance in (12, 24, 40, 60, 85, 115, 150):
            for dx, dy in ((1, 0), (-1, 0), (0, -1), (0, 1), (.8, -.6), (.8, .6), (-.8, -.6), (-.8, .6)):
                left = x + dx * distance + (0 if dx > 0 else -width if dx < 0 else -width / 2)
                candidates.append((left, y + dy * distance, distance))
        for left, middle, distance in candidates:
            box = (left - 2, middle - LINE / 2, left + width + 2, middle + LINE / 2)
            inside = box[0] > panel.x0 and box[2] < panel.x1 and box[1] > TOP and box[3] < HEIGHT - BOTTOM
            if inside and all(box[2] < t[0] or box[0] > t[2] or box[3] < t[1] or box[1] > t[3] for t in taken):
                taken.append(box)
                placed.append((text, left, middle, distance > 24))
                break
        else:
            raise SystemExit(f"error: no room for the label {text}")
    return placed


def draw(points: list[Point], metric: int, what: str, path: Path, references: References) -> None:
    shown = [p for p in points if "scaled" not in p.title]
    values = [p.accuracy[light][metric] for p in shown for light in LIGHTS] + [
        figures[light][metric] for figures in references.values() for light in LIGHTS]
    y_range = (100 * min(values) * 0.6, 100 * max(values) * 1.4)
    areas = [p.mm2 for p in shown] + [p.thesis_mm2 for p in shown if p.thesis_mm2]
    x_range = (min(areas) * 0.75, max(areas) * 1.35)
    styles = plot_style.load()
    script = [f"set terminal svg size {WIDTH},{HEIGHT} font 'sans,{FONT}' background '#ffffff'",
              "set multiplot", "set logscale xy", "set grid lc rgb '#dddddd'", "unset key",
              "set xtics (0.5,0.7,1,1.5,2,3,5,7,10,15)", "set ytics (0.5,1,2,3,5,10,20,30,50,100)",
              f"set xrange [{x_range[0]}:{x_range[1]}]", f"set yrange [{y_range[0]}:{y_range[1]}]",
              "set xlabel 'area of 200 x 160 pixels, mm^2'", f"set ylabel '{what}, %'"]
    for index, (light, klux) in enumerate(LIGHTS.items()):
        panel = Panel(index, x_range, y_range)
        marks, labels = [], []
        script += ["unset label", "unset arrow", "unset object",
                   f"set lmargin at screen {panel.x0 / WIDTH}", f"set rmargin at screen {panel.x1 / WIDTH}",
                   f"set tmargin at screen {1 - TOP / HEIGHT}", f"set bmargin at screen {BOTTOM / HEIGHT}",
                   f"set title '{what} in %: all scenes but the flats, {klux} klux, sensor {PRESET}' offset 0,-0.4"]
        plots = []
        for p in shown:
            y = 100 * p.accuracy[light][metric]
            style = plot_style.style(p.family, styles)
            marks.append(panel.at(p.mm2, y))
            plots.append((p.mm2, y, style.marker, 0.6 if p.variant else 1.1, style.colour))
            if not p.variant:
                labels.append((p.title, *marks[-1]))
            if p.thesis_mm2:
                marks.append(panel.at(p.thesis_mm2, y))
                plots.append((p.thesis_mm2, y, THESIS_MARKER, 1.1, style.colour))
        for name, figures in references.items():
            level = 100 * figures[light][metric]
            reference_y = panel.at(x_range[0], level)[1]
            style = plot_style.style(name, styles)
            script.append(f"set arrow from graph 0, first {level} to graph 1, first {level} nohead dt {style.dash} "
                          f"lc rgb '{style.colour}'")
            script.append(f"set label '{name}' at graph 0.98, first {level} right offset 0,0.6 tc rgb '{style.colour}'")
            marks += [(panel.x1 - 20 - k * 15, reference_y) for k in range(int((panel.x1 - panel.x0) / 15))]
            marks += [(panel.x1 - 12 - LETTER * k, reference_y - 10) for k in range(len(name))]
        script.append(f"set label '{LEGEND}' at graph 0.98, graph 0.05 right tc rgb '#444444'")
        marks += [(panel.x1 - 12 - LETTER * k, HEIGHT - BOTTOM - 25) for k in range(len(LEGEND))]
        for text, left, middle, line in place_labels(panel, labels, marks):
            x, y = next((lx, ly) for name, lx, ly in labels if name == text)
            script.append(f"set label '{text}' at screen {left / WIDTH}, {1 - middle / HEIGHT} left")
            if line:
                end = left if left > x else left + LETTER * len(text) if left + LETTER * len(text) < x else x
                script.append(f"set arrow from screen {end / WIDTH}, {1 - middle / HEIGHT} to screen {x / WIDTH}, "
                              f"{1 - y / HEIGHT} nohead lc rgb '#999999'")
        script += [f"$p{index}_{k} << END\n{x} {y}\nEND" for k, (x, y, *_rest) in enumerate(plots)]
        script.append("plot " + ", ".join(
            f"$p{index}_{k} with points pt {kind} ps {size} lc rgb '{colour}' notitle"
            for k, (_x, _y, kind, size, colour) in enumerate(plots)))
    script.append("unset multiplot")
    with tempfile.TemporaryDirectory() as folder:
        drawn = Path(folder) / "plot.svg"
        script.insert(1, f"set output '{drawn}'")
        result = subprocess.run(["gnuplot"], input="\n".join(script) + "\nset output\n", text=True, capture_output=True)
        if result.returncode != 0 or not drawn.is_file():
            raise SystemExit(f"error: gnuplot failed: {result.stderr.strip()}")
        path.write_text(drawn.read_text(encoding="utf-8"), encoding="utf-8")


# ---- Report ----------------------------------------------------------------------------------------------

def dominated(point: Point, points: list[Point], light: str) -> bool:
    value = point.accuracy[light][0]
    return any(p.mm2 <= point.mm2 and p.accuracy[light][0] <= value and
               (p.mm2 < point.mm2 or p.accuracy[light][0] < value) for p in points)


def report(points: list[Point], missing: list[str], scenes: Scenes, references: References) -> str:
    lines = [
        "# Area against accuracy", "",
        "Written by `make pareto`. Areas: 200 columns of 160 pixels, from [area.csv](area.csv) (`make synth`). "
        "Accuracies: from [scenes.csv](scenes.csv) and [scenes_variants.csv](scenes_variants.csv) (`make scenes`), "
        f"preset `{PRESET}`, over all scenes except flat targets: {', '.join(scenes.names(flats=False))}. For variants that "
        "change results, fewer columns of each scene were read.", "",
        "![Pixels off by more than 3 %](pareto.svg)", "", "![Relative rmse](pareto_rmse.svg)", "",
        "Large marks: read-outs. Small marks: their variants. Crosses: the area that the thesis states (Table 5), at the accuracy "
        "measured here. A row is on the front if no other row has a smaller area and fewer pixels above 3 %.", ""]
    if missing:
        lines += [f"**Missing** (no area or no accuracy yet): {', '.join(missing)}.", ""]
    lines += ["| read-out | mm2 | thesis mm2 | bits a pixel | indoor: above 3 %, % | rmse, % | front | outdoor: above 3 %, % "
              "| rmse, % | front |", "|---|---:|---:|---:|---:|---:|:---:|---:|---:|:---:|"]
    for p in sorted(points, key=lambda p: p.mm2):
        cells = [p.title, f"{p.mm2:.2f}", f"{p.thesis_mm2:.2f}" if p.thesis_mm2 else "", p.bits]
        for light in LIGHTS:
            above, rmse = p.accuracy[light]
            cells += [f"{100 * above:.2f}", f"{100 * rmse:.2f}", "" if dominated(p, points, light) else "x"]
        lines.append("| " + " | ".join(cells) + " |")
    for name, values in references.items():
        cells = [name, "", "", ""]
        for light in LIGHTS:
            cells += [f"{100 * values[light][0]:.2f}", f"{100 * values[light][1]:.2f}", ""]
        lines.append("| " + " | ".join(cells) + " |")
    lines += ["", "## Goals", "", "| goal | measured | met |", "|---|---|:---:|"]
    lines += [f"| {goal} | {measured} | {met} |" for goal, measured, met in goals(scenes)]
    return "\n".join(lines) + "\n"


def main() -> int:
    scenes = Scenes()
    points, missing = collect(scenes)
    references: References = {}
    for name in REFERENCES:
        references[name] = {light: found for light, klux in LIGHTS.items() if (found := scenes.overall(klux, name))}
        if len(references[name]) < len(LIGHTS):
            raise SystemExit(f"error: reports/scenes.csv has no '{name}' on every scene: run `make scenes`")
    with open(WRITTEN / "pareto.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["title", "read_out", "variant", "mm2", "thesis_mm2", "bits_per_pixel"] +
                        [f"{light}_{name}" for light in LIGHTS for name in ("above_3_percent", "relative_rmse")])
        for p in points:
            writer.writerow([f"{p.title}", p.family, int(p.variant), f"{p.mm2:.4f}", p.thesis_mm2 or "", p.bits] +
                            [f"{value:.6f}" for light in LIGHTS for value in p.accuracy[light]])
    (WRITTEN / "pareto.md").write_text(report(points, missing, scenes, references), encoding="utf-8")
    draw(points, 0, "pixels off by more than 3 %", WRITTEN / "pareto.svg", references)
    draw(points, 1, "relative rmse", WRITTEN / "pareto_rmse.svg", references)
    print(f"reports/pareto.md: {len(points)} configurations")
    for goal, measured, met in goals(scenes):
        print(f"  {met:7} {goal}: {measured}")
    if missing:
        print(f"missing, not shown: {', '.join(missing)}")
    return 0


if __name__ == "__main__":
    program.run(main)
