#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""poolPointer's goals that collide, as curves: how the frame is shared among its phases, and how many candidates a
group keeps at what area.

`trade.py DTOF`: runs `DTOF scenes` with the variants, takes the areas of `make synth-growth` (reports/growth.csv),
writes reports/trade.md, trade.csv and trade.svg. `trade.py --draw`: draws trade.svg from trade.csv again.
"""

import csv
import math
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import plot_style
from dtof_synth import growth, program
from dtof_synth.configuration import load
from dtof_synth.goals import ARRAY_MM2
from figures.small import is_small, written_root

ROOT = Path(__file__).resolve().parent.parent
REPORTS = ROOT / "reports"
WRITTEN = written_root(ROOT) / "reports"
BUILD = written_root(ROOT) / "build" / "trade"

# 64ths of the frame: coarse, track; the rest is the pointer phase.
SCHEDULES = ((18, 30), (16, 30), (14, 40), (14, 35), (14, 30), (14, 25), (14, 20), (12, 35), (12, 30), (12, 25))
SCENES = ("flat", "room", "planes", "clutter", "poles", "isolated")
COLUMNS = 2 if is_small() else 50
SINGLE_COLUMNS = 20 if is_small() else 200  # single pixels are few
SEED = 1
BOUND_GOAL = 1.5
OTHER_MARKER = 4  # gnuplot's open square, for the second figure in a panel
FIGURES = {"bound_ratio_1m_14klux": "flat 1 m, 14: rmse / bound", "rmse_4m_50klux": "flat 4 m, 50: rmse, %",
           "lost_14klux": "single pixels lost, 14, %", "outliers_14klux": "scenes, 14: above 10 %, %",
           "above_3_50klux": "scenes, 50: above 3 %, %", "outliers_50klux": "scenes, 50: above 10 %, %"}


@dataclass
class Point:
    label: str
    variant: str
    figures: dict[str, float]
    mm2: float = math.nan  # schedules have no area of their own


def run_scenes(dtof: str, scenes: tuple[str, ...], klux: tuple[str, ...], columns: int, variants: list[str],
               folder: Path) -> list[dict[str, str]]:
    command = [dtof, "scenes", "--preset", "thesis", "--klux", *klux, "--scene", *scenes, "--readout", "ezpointer",
               "--columns", str(columns), "--seed", str(SEED), "--out", str(folder)]
    for variant in variants:
        command += ["--variant", variant]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with (folder / "scenes.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def by_variant(rows: list[dict[str, str]], count: int) -> list[dict[tuple[str, str], dict[str, str]]]:
    """Rows of each variant by scene and light level. A scene's rows follow ezPointer's, in the command line's order."""
    found: list[dict[tuple[str, str], dict[str, str]]] = [{} for _ in range(count)]
    places: dict[tuple[str, str], int] = {}
    for row in rows:
        key = (row["klux"], row["scene"])
        place = places[key] = places.get(key, -1) + 1
        if 1 <= place <= count:
            found[place - 1][key] = row
    return found


def share(rows: dict[tuple[str, str], dict[str, str]], klux: str, column: str) -> float:
    """Share in per cent of the pixels of all scenes except the flat ones."""
    chosen = [row for (light, scene), row in rows.items() if light == klux and not scene.startswith("flat")]
    pixels = sum(int(row["pixels"]) for row in chosen)
    return 100 * sum(int(row["pixels"]) * float(row[column]) for row in chosen) / pixels


def measure(dtof: str, points: list[Point]) -> None:
    variants = [point.variant for point in points]
    scenes = by_variant(run_scenes(dtof, SCENES, ("14", "50"), COLUMNS, variants, BUILD / "scenes"), len(points))
    singles = by_variant(run_scenes(dtof, ("isolated",), ("14",), SINGLE_COLUMNS, variants, BUILD / "singles"),
                         len(points))
    for point, rows, single in zip(points, scenes, singles):
        near, far = rows["14", "flat 1 m"], rows["50", "flat 4 m"]
        point.figures = {
            "bound_ratio_1m_14klux": float(near["relative_rmse"]) / float(near["relative_bound"]),
            "rmse_4m_50klux": 100 * float(far["relative_rmse"]),
            "lost_14klux": 100 * float(single["14", "isolated"]["single_above_10_percent"]),
            "outliers_14klux": share(rows, "14", "above_10_percent"),
            "above_3_50klux": share(rows, "50", "above_3_percent"),
            "outliers_50klux": share(rows, "50", "above_10_percent")}


def read(points: list[Point]) -> None:
    """Sets the points' figures from reports/trade.csv."""
    with (REPORTS / "trade.csv").open(newline="", encoding="utf-8") as file:
        found = {row["variant"]: row for row in csv.DictReader(file)}
    for point in points:
        if point.variant not in found:
            raise SystemExit(f"error: reports/trade.csv has no {point.variant}: run `make trade` first")
        point.figures = {name: float(found[point.variant][name]) for name in FIGURES}


def areas() -> dict[str, float]:
    path = REPORTS / "growth.csv"
    found = {}
    if path.is_file():
        with path.open(newline="", encoding="utf-8") as file:
            found = {row["value"]: float(row["total_mm2"]) for row in csv.DictReader(file)
                     if row["readout"] == "poolpointer" and row["parameter"] == "LABELS"}
    if not found:
        raise SystemExit("error: reports/growth.csv has no areas of poolpointer: run `make synth-growth` first")
    return found


def plot(schedules: list[Point], candidates: list[Point], limit: float, path: Path) -> None:
    def block(name: str, data: list[tuple[float, float, str]]) -> list[str]:
        return [f"${name} << EOD", *(f'{x} {y} "{label}"' for x, y, label in data), "EOD"]

    style = plot_style.style("poolPointer", plot_style.load())

    def points(name: str, title: str, marker: int = style.marker) -> str:
        return (f"${name} using 1:2 with points pt {marker} lc rgb '{style.colour}' title '{title}', "
                f"${name} using 1:2:3 with labels offset 0.6,0.7 left font ',10' notitle")

    scenes = ", ".join(SCENES[1:])
    frame = sorted(schedules, key=lambda point: point.figures["bound_ratio_1m_14klux"])
    area = sorted(candidates, key=lambda point: point.mm2)
    script = [
        *block("outliers", [(p.figures["bound_ratio_1m_14klux"], p.figures["outliers_50klux"], p.label) for p in frame]),
        *block("lost", [(p.mm2, p.figures["lost_14klux"], p.label) for p in area]),
        *block("wrong", [(p.mm2, p.figures["outliers_50klux"], "") for p in area]),
        "set terminal svg size 1240,520 font 'sans,13' background '#ffffff'", "set multiplot layout 1,2",
        "set grid lc rgb '#dddddd'", "set offsets graph 0.06, graph 0.14, graph 0.1, graph 0.02",
        f"set title 'pixels above 10 % in %: {scenes}; 50 klux, sensor thesis' font ',12'", "set xlabel 'rmse over the bound: flat at 1 m, 14 klux (labels: coarse / track phase in 64ths of the frame)'",
        "set ylabel 'pixels above 10 %, %'", "unset key",
        f"set arrow 1 from {BOUND_GOAL},graph 0 to {BOUND_GOAL},graph 1 nohead dt 2 lc rgb '#888888'",
        f"set label 1 'goal' at {BOUND_GOAL},graph 0.04 right offset -0.4,0",
        "plot " + points("outliers", ""),
        "set title 'pixels in %: isolated at 14 klux, the same scenes at 50 klux, sensor thesis' font ',12'", "set xlabel 'area of 200 x 160 pixels, mm^2 (labels: candidates x bits of a score)'",
        "set ylabel 'pixels, %'", "set key top right", "set logscale y", "set yrange [0.02:10]",
        f"set arrow 1 from {limit},graph 0 to {limit},graph 1 nohead dt 2 lc rgb '#888888'",
        f"set label 1 'goal' at {limit},graph 0.04 right offset -0.4,0",
        "plot " + points("lost", "single pixels lost, 14 klux") + ", "
        + points("wrong", "above 10 % in the scenes, 50 klux", OTHER_MARKER), "unset multiplot"]
    drawn = BUILD / "trade.svg"
    result = subprocess.run(["gnuplot"], input=f"set output '{drawn}'\n" + "\n".join(script) + "\nset output\n", text=True,
                            capture_output=True)
    if result.returncode != 0:
        raise SystemExit(f"error: gnuplot: {result.stderr.strip()}")
    drawn.replace(path)


def rank_correlation(pairs: list[tuple[float, float]]) -> float:
    """Kendall's tau-a: 1 if the second figure always rises with the first, -1 if it always falls; ties count as 0."""
    score, compared = 0, 0
    for index, (x, y) in enumerate(pairs):
        for other_x, other_y in pairs[index + 1:]:
            if x != other_x:
                compared += 1
                product = (x - other_x) * (y - other_y)
                score += (product > 0) - (product < 0)
    return score / compared if compared else 0.0


def change(tau: float, falls: str, rises: str) -> str:
    """Words for a rank correlation. A trend needs half of the pairs more in one direction than in the other."""
    trend = falls if tau <= -0.5 else rises if tau >= 0.5 else None
    return f"{trend} (rank correlation {tau:+.2f})" if trend else f"no clear trend (rank correlation {tau:+.2f})"


def numbers(point: Point, mark: str) -> tuple[int, int]:
    """The two numbers of a label."""
    first, second = point.label.split(mark)
    return int(first), int(second)


def schedule_sentence(schedules: list[Point]) -> str:
    """Sentence on the relation between the phases' lengths and the figures."""
    phases = [(point, *numbers(point, "/")) for point in schedules]
    lost = rank_correlation([(coarse, point.figures["lost_14klux"]) for point, coarse, _ in phases])
    wrong = rank_correlation([(coarse, point.figures["outliers_50klux"]) for point, coarse, _ in phases])
    precision = rank_correlation([(64 - coarse - track, point.figures["bound_ratio_1m_14klux"])
                                  for point, coarse, track in phases])
    return (f"With a longer coarse phase the single pixels lost show {change(lost, 'a fall', 'a rise')} and the outliers "
            f"of the scenes at 50 klux {change(wrong, 'a fall', 'a rise')}; with a longer pointer phase the rmse over the "
            f"bound shows {change(precision, 'a fall', 'a rise')}.")


def candidate_sentence(candidates: list[Point]) -> str:
    """Sentence on the relation of the candidates' number and width to the figures, and on the effect of a score bit."""
    sizes = {numbers(point, "x"): point for point in candidates}
    lost = rank_correlation([(labels, point.figures["lost_14klux"]) for (labels, _), point in sizes.items()])
    cost = rank_correlation([(labels, point.mm2) for (labels, _), point in sizes.items()])
    text = (f"With more candidates the single pixels lost show {change(lost, 'a fall', 'a rise')}, the area "
            f"{change(cost, 'a fall', 'a rise')}.")
    for (labels, bits), point in sorted(sizes.items()):
        wider = sizes.get((labels, bits + 1))
        if wider:
            one, other = point.figures["outliers_50klux"], wider.figures["outliers_50klux"]
            verdict = "worse than" if one > other else "better than" if one < other else "as good as"
            text += (f" At {labels} candidates, scores of {bits} bits are {verdict} those of {bits + 1} at 50 klux "
                     f"({one:.2f} against {other:.2f} % above 10 %).")
    return text


def table(title: str, points: list[Point], with_area: bool) -> list[str]:
    head = [title, *(["mm2"] if with_area else []), *FIGURES.values()]
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    for point in points:
        cells = [point.label, *([f"{point.mm2:.3f}"] if with_area else []),
                 *(f"{point.figures[name]:.2f}" for name in FIGURES)]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    base = load(ROOT / "configurations.toml")["poolpointer"]
    area = areas()
    schedules = [Point(f"{coarse}/{track}", f"poolpointer:COARSE_SHARE={coarse},TRACK_SHARE={track}", {})
                 for coarse, track in SCHEDULES]
    candidates = [Point(f"{labels}x{bits}", f"poolpointer:LABELS={labels},SCORE_BITS={bits}", {}, area[f"{labels}x{bits}"])
                  for labels, bits in growth.CANDIDATES]
    if sys.argv[1] == "--draw":
        read(schedules + candidates)
        plot(schedules, candidates, ARRAY_MM2["poolpointer"], WRITTEN / "trade.svg")
        return 0
    try:
        measure(sys.argv[1], schedules + candidates)
    except subprocess.CalledProcessError as error:
        print(f"error: dtof-study scenes ended with exit code {error.returncode}", file=sys.stderr)
        return 1
    limit = ARRAY_MM2["poolpointer"]
    BUILD.mkdir(parents=True, exist_ok=True)
    plot(schedules, candidates, limit, WRITTEN / "trade.svg")
    lines = ["# Trade-offs of poolPointer", "",
             f"Written by `make trade`: preset `thesis`, seed {SEED}, 14 and 50 klux, {COLUMNS} columns of the scenes "
             f"{', '.join(SCENES[1:])}; for single pixels {SINGLE_COLUMNS} columns of isolated. The areas come from "
             "`make synth-growth`.", "", "![trade](trade.svg)", "", "## Shares of the frame", "",
             "Labels: shares of the coarse phase and of the track phase, in 64ths of the acquisitions. Both are registers, so they "
             "do not change the area. "
             + schedule_sentence(schedules), "",
             *table("coarse/track", schedules, with_area=False), "", "## Candidates of a group", "",
             f"Labels: number of candidates x bits of a score; {base['LABELS']}x{base['SCORE_BITS']} is poolPointer's default. "
             + candidate_sentence(candidates), "",
             *table("candidates", candidates, with_area=True), ""]
    (WRITTEN / "trade.md").write_text("\n".join(lines), encoding="utf-8")
    with (WRITTEN / "trade.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["variant", "total_mm2", *FIGURES])
        for point in schedules + candidates:
            writer.writerow([point.variant, "" if math.isnan(point.mm2) else f"{point.mm2:.4f}",
                             *(f"{point.figures[name]:.4f}" for name in FIGURES)])
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    program.run(main)
