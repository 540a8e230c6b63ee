#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Draws reports/growth.png from reports/growth.csv (`make synth-growth`): how cost grows with one parameter at a time."""

import csv
import subprocess
import sys
from pathlib import Path

import plot_style
from dtof_synth import program
from dtof_synth.configuration import load

ROOT = Path(__file__).resolve().parent.parent
REPORTS = ROOT / "reports"
PARAMETERS = {"NP": "bits of a timestamp", "NB": "bits of the coarse index", "PIXELS_PER_SRAM": "pixels of a column",
              "SRAM_NUM": "columns"}
METRICS = {"total_mm2": "area, mm^2", "bits_per_pixel": "memory, bits a pixel", "fmax_slow_mhz": "slow-corner clock, MHz"}
CLOCK = "fmax_slow_mhz"


def script(rows: list[dict[str, str]], output: Path) -> str:
    """Gnuplot script of one picture: a column per parameter, a row per figure."""
    styles = plot_style.load()
    titles = {configuration.readout: configuration.title for configuration in load(ROOT / "configurations.toml").values()
              if not configuration.variant_of}
    blocks: list[str] = []
    plots: list[str] = []
    for metric, label in METRICS.items():
        for parameter, meaning in PARAMETERS.items():
            chosen = [row for row in rows if row["parameter"] == parameter]
            series = []
            for readout in dict.fromkeys(row["readout"] for row in chosen):
                name = f"$d{len(blocks)}"
                points = [f"{row['value']} {row[metric]}" for row in chosen if row["readout"] == readout]
                blocks.append(f"{name} << EOD\n" + "\n".join(points) + "\nEOD")
                style = plot_style.style(titles[readout], styles)
                series.append(f"{name} using 1:2 with linespoints lw 2 {style.lines()} title '{style.title}'")
            ticks = ", ".join(dict.fromkeys(row["value"] for row in chosen))
            low, high = (250, 400) if metric == CLOCK else ("*", "*")
            plots += ["unset logscale y" if metric == CLOCK else "set logscale y", f"set yrange [{low}:{high}]",
                      f"set xtics ({ticks})", f"set xlabel '{parameter}: {meaning}' noenhanced", f"set ylabel '{label}'",
                      "plot " + ", ".join(series)]
    head = ["set terminal pngcairo size 1500,1000 font 'DejaVu Sans,10'", f"set output '{output}'",
            f"set multiplot layout {len(METRICS)},{len(PARAMETERS)} title 'Area in mm^2, memory in bits a pixel and clock in "
            "MHz: the array of 200 x 160 pixels with one parameter changed'", "set grid",
            "set key at graph 0.5, graph 1.02 center bottom horizontal", "set tmargin 4",
            "set offsets graph 0.05, graph 0.05"]
    return "\n".join(blocks + head + plots + ["unset multiplot", ""])


def main() -> int:
    path = REPORTS / "growth.csv"
    if not path.is_file():
        print("error: reports/growth.csv is missing: run `make synth-growth` first", file=sys.stderr)
        return 1
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    drawn = REPORTS / "growth.png"
    result = subprocess.run(["gnuplot"], input=script(rows, drawn), text=True, capture_output=True)
    if result.returncode != 0:
        print(f"error: gnuplot: {result.stderr.strip()}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    program.run(main)
