#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The project's read-outs and their rivals: accuracy over bits a pixel.

`rivals.py DTOF_STUDY OPTION ...`: runs `DTOF_STUDY rivals OPTION ...` with the bits of the project's read-outs as
synthesis reports them (reports/area.csv), and draws rivals_<klux>klux.svg for each light beside its tables.
`rivals.py --draw FOLDER`: draws them again from FOLDER/rivals.csv.
"""

import csv
import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "synth"))

import plot_style  # noqa: E402

WIDTH, HEIGHT = 1000, 640
LEFT, RIGHT, TOP, BOTTOM = 75, 310, 45, 60
FONT = 13
RIVAL_COLOUR = "#6b6b6b"
RIVAL_MARKER = 7  # gnuplot's filled circle, small
SHARE = "above_3_percent"
LEAST_PERCENT = 0.02  # shares below are drawn here: a logarithmic axis has no zero


@dataclass
class Point:
    title: str
    kind: str  # read-out, rival, reference
    bits: float | None
    percent: float
    low: float
    high: float


def known_bits(area: Path) -> dict[str, str]:
    """Bits a pixel by the read-outs' names on the command line."""
    if not area.is_file():
        return {}
    with area.open(newline="", encoding="utf-8") as file:
        return {row["configuration"].replace("_", "-"): row["bits_per_pixel"] for row in csv.DictReader(file)
                if row["configuration"].replace("_", "-") == row["readout"].replace("_", "-")}


def points_of(path: Path) -> dict[str, list[Point]]:
    """By light: all scenes with depth together."""
    lights: dict[str, list[Point]] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["scene"] == "all":
                low, high = (100 * float(row[SHARE + part]) for part in ("_low", "_high"))
                lights.setdefault(row["klux"], []).append(
                    Point(row["estimator"], row["kind"], float(row["bits_per_pixel"]) if row["bits_per_pixel"] else None,
                          100 * float(row[SHARE]), low, high))
    return lights


def front(points: list[Point]) -> list[Point]:
    """What no other is better than with as few bits."""
    best, found = math.inf, []
    for point in sorted((p for p in points if p.bits), key=lambda p: (p.bits, p.percent)):
        if point.percent < best:
            best = point.percent
            found.append(point)
    return found


def script(klux: str, points: list[Point], output: Path) -> str:
    """Of gnuplot: numbered points, and beside them what the numbers are."""
    styles = plot_style.load()
    shown = sorted((p for p in points if p.bits), key=lambda p: (p.bits, p.percent))
    level = lambda percent: max(percent, LEAST_PERCENT)  # noqa: E731
    bits = [p.bits for p in shown]
    lines = [f"set terminal svg size {WIDTH},{HEIGHT} font 'sans,{FONT}' background '#ffffff'", f"set output '{output}'",
             "set logscale xy", "set grid lc rgb '#dddddd'", "unset key",
             f"set lmargin at screen {LEFT / WIDTH}", f"set rmargin at screen {1 - RIGHT / WIDTH}",
             f"set tmargin at screen {1 - TOP / HEIGHT}", f"set bmargin at screen {BOTTOM / HEIGHT}",
             f"set title 'Pixels off by more than 3 %, in %: all scenes but the flats, {klux} klux' offset 0,-0.4",
             "set xlabel 'memory, bits a pixel'", "set ylabel 'pixels above 3 %, %'",
             f"set xrange [{min(bits) * 0.8}:{max(bits) * 1.25}]",
             f"set yrange [{0.7 * min(level(p.percent) for p in points)}:{min(100, 1.4 * max(level(p.high) for p in points))}]"]
    best = front(points)
    lines += ["$front << END"] + [f"{p.bits} {level(p.percent)}" for p in best] + ["END"]
    plots = ["$front with steps lc rgb '#bbbbbb' notitle"]
    height = (HEIGHT - TOP - BOTTOM) / max(len(shown), 1)
    for number, p in enumerate(shown, 1):
        if p.kind == "rival":
            colour, marker, size = RIVAL_COLOUR, RIVAL_MARKER, 0.5
        else:
            style = plot_style.style(p.title, styles)
            colour, marker, size = style.colour, style.marker, 1.1
        lines += [f"$p{number} << END", f"{p.bits} {level(p.percent)} {level(p.low)} {level(p.high)}", "END"]
        plots.append(f"$p{number} with yerrorbars pt {marker} ps {size} lc rgb '{colour}' notitle")
        weight = "{/:Bold %d}" if p in best else "%d"
        lines.append(f"set label '{weight % number}' at {p.bits}, {level(p.percent)} offset 0.7,0.4 tc rgb '{colour}' font ',10'")
        lines.append(f"set label '{weight % number}  {p.title}, {p.bits:g}' at screen {1 - (RIGHT - 15) / WIDTH}, "
                     f"{1 - (TOP + (number - 0.5) * height) / HEIGHT} left tc rgb '{colour}' font ',{min(11, height * 0.75):.1f}'")
    for p in points:
        if p.kind == "reference" and p.bits is None:
            style = plot_style.style(p.title, styles) if "filter" in p.title else None
            if style:
                lines.append(f"set arrow from graph 0, first {level(p.percent)} to graph 1, first {level(p.percent)} nohead "
                             f"dt {style.dash} lc rgb '{style.colour}'")
                lines.append(f"set label '{p.title}' at graph 0.98, first {level(p.percent)} right offset 0,0.5 "
                             f"tc rgb '{style.colour}' font ',10'")
    lines.append("plot " + ", ".join(plots))
    return "\n".join(lines) + "\nset output\n"


def draw(folder: Path) -> None:
    for klux, points in points_of(folder / "rivals.csv").items():
        if not any(p.bits for p in points):
            continue
        with tempfile.TemporaryDirectory() as temporary:
            drawn = Path(temporary) / "plot.svg"
            result = subprocess.run(["gnuplot"], input=script(klux, points, drawn), text=True, capture_output=True, check=False)
            if result.returncode != 0 or not drawn.is_file():
                raise SystemExit(f"error: gnuplot failed: {result.stderr.strip()}")
            (folder / f"rivals_{klux}klux.svg").write_text(drawn.read_text(encoding="utf-8"), encoding="utf-8")


def main() -> None:
    if len(sys.argv) == 3 and sys.argv[1] == "--draw":
        draw(Path(sys.argv[2]))
        return
    if len(sys.argv) < 4 or "--out" not in sys.argv[2:-1]:
        raise SystemExit(f"usage: {__doc__}\nAn option must be --out FOLDER.")
    options = sys.argv[2:]
    bits = [f"{name}={value}" for name, value in known_bits(ROOT / "reports" / "area.csv").items()]
    result = subprocess.run([sys.argv[1], "rivals", *options, *(["--bits", *bits] if bits else [])], check=False)
    if result.returncode != 0:
        raise SystemExit(result.returncode)
    draw(Path(options[options.index("--out") + 1]))


if __name__ == "__main__":
    main()
