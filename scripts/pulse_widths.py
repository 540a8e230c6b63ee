#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Read-outs beside the matched filter for pulses of other widths: build/pulse_widths/pulse_widths.md, .csv and .svg.

`pulse_widths.py DTOF_STUDY [OPTION ...]`: the preset thesis with each width of FWHM_BINS and the same energy per pulse; options
are those of `dtof-study scenes`, such as --seed. poolPointer is read twice, with windows that follow the pulse and with those
for 45 bins.
"""

import csv
import subprocess
import sys
import tomllib
from collections import defaultdict
from pathlib import Path

import plot_style
from dtof_synth import program
from figures.small import is_small, written_root

ROOT = Path(__file__).resolve().parent.parent
PRESET = ROOT / "models" / "dtof" / "sensor" / "presets" / "thesis.toml"
FOLDER = written_root(ROOT) / "build" / "pulse_widths"
FWHM_BINS = (8, 45) if is_small() else (8, 12, 20, 45, 90)
POOLED = ("poolpointer", "poolpointer-lean")
READOUTS = ("hispointer", *POOLED)
WINDOWS_FOR_45 = " CELL_SHIFT=9"
FIXED = " (windows for 45 bins)"
SCENES = ("flat", "room") if is_small() else ("flat", "room", "planes", "clutter", "poles")
COLUMNS = 2 if is_small() else 20
LIGHTS = ("14",) if is_small() else ("14", "50")
WALL = "flat 3 m"


def sensor_of(bins: int, preset: str) -> str:
    """Sensor file of the preset with a pulse of `bins` bins."""
    table = tomllib.loads(preset)
    width = bins * table["tdc"]["range_ns"] / 2 ** table["tdc"]["timestamp_bits"]
    return (preset.replace('name = "thesis"', f'name = "fwhm{bins}"')
            .replace(f"pulse_fwhm_ns = {table['laser']['pulse_fwhm_ns']}", f"pulse_fwhm_ns = {width!r}"))


class Figures:
    """Error figures of one read-out at one pulse width and one light level."""

    def __init__(self) -> None:
        self.pixels = 0
        self.above = {"above_3_percent": 0.0, "above_10_percent": 0.0}
        self.sigma = float("nan")  # relative, of the wall at 3 m: its median error as that of a normal variable

    def add(self, row: dict[str, str]) -> None:
        if row["scene"] == WALL:
            self.sigma = float(row["median_error_over_bound"]) * float(row["relative_bound"])
        if not row["scene"].startswith("flat "):
            pixels = int(row["pixels"])
            self.pixels += pixels
            for name in self.above:
                self.above[name] += pixels * float(row[name])

    def percent(self, name: str) -> float:
        return 100 * self.above[name] / self.pixels


def rows_of(estimator: str, titles: set[str]) -> list[str]:
    """Table rows of an estimator; `titles`: the sensor's estimators. If the pulse needs the windows for 45 bins anyway, both rows are the
    same."""
    title, changed, _ = estimator.partition(WINDOWS_FOR_45)
    if changed:
        return [title + FIXED]
    return [title, title + FIXED] if title.startswith("poolPointer") and title + WINDOWS_FOR_45 not in titles else [title]


def read(path: Path) -> dict[tuple[str, int, str], Figures]:
    """Figures by light level, width and estimator."""
    found: dict[tuple[str, int, str], Figures] = defaultdict(Figures)
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    titles: dict[str, set[str]] = defaultdict(set)
    for row in rows:
        titles[row["sensor"]].add(row["estimator"])
    for row in rows:
        for name in rows_of(row["estimator"], titles[row["sensor"]]):
            found[row["klux"], int(row["sensor"].removeprefix("fwhm")), name].add(row)
    return dict(found)


def estimators(figures: dict[tuple[str, int, str], Figures]) -> list[str]:
    return list(dict.fromkeys(estimator for _, _, estimator in figures))


def tables(figures: dict[tuple[str, int, str], Figures]) -> str:
    text = []
    for klux in LIGHTS:
        text.append(f"## {klux} klux\n")
        for title, cell in (("Pixels above 3 % / 10 %, in %, all scenes but the flats",
                             lambda f: f"{f.percent('above_3_percent'):.2f} / {f.percent('above_10_percent'):.2f}"),
                            ("Robust sigma at 3 m, % of the distance", lambda f: f"{100 * f.sigma:.3f}")):
            text.append(f"{title}:\n\n| estimator | " + " | ".join(f"{bins} bins" for bins in FWHM_BINS) + " |\n"
                        + "|---|" + "---:|" * len(FWHM_BINS))
            text += [f"| {name} | " + " | ".join(cell(figures[klux, bins, name]) for bins in FWHM_BINS) + " |"
                     for name in estimators(figures)]
            text.append("")
    return "\n".join(text)


def table_csv(figures: dict[tuple[str, int, str], Figures]) -> str:
    lines = ["klux,fwhm_bins,estimator,above_3_percent,above_10_percent,robust_sigma"]
    for (klux, bins, name), f in figures.items():
        lines.append(f"{klux},{bins},{name},{f.percent('above_3_percent') / 100:.6f},{f.percent('above_10_percent') / 100:.6f},"
                     f"{f.sigma:.6f}")
    return "\n".join(lines) + "\n"


def draw(figures: dict[tuple[str, int, str], Figures], output: Path) -> None:
    styles = plot_style.load()
    lines = ["set terminal svg size 1000,480 font 'sans,13' background '#ffffff'", f"set output '{output}'",
             "set logscale xy", "set grid lc rgb '#dddddd'", "set key bottom left", f"set xtics ({', '.join(map(str, FWHM_BINS))})",
             "set xlabel 'pulse, FWHM in bins'", "set ylabel 'pixels above 3 %, %'", "set multiplot layout 1,2"]
    for klux in LIGHTS:
        lines.append(f"set title '{klux} klux'")
        plots = []
        for number, name in enumerate(estimators(figures)):
            style = plot_style.style(name, styles)
            lines += [f"$e{number} << END", *(f"{bins} {max(figures[klux, bins, name].percent('above_3_percent'), 0.01)}"
                                              for bins in FWHM_BINS), "END"]
            dash = 3 if name.endswith(FIXED) else style.dash
            plots.append(f"$e{number} with linespoints pt {style.marker} dt {dash} lc rgb '{style.colour}' title '{name}'")
        lines.append("plot " + ", ".join(plots))
        lines.append("unset key")
    result = subprocess.run(["gnuplot"], input="\n".join(lines) + "\nunset multiplot\nset output\n", text=True,
                            capture_output=True, check=False)
    if result.returncode != 0:
        raise SystemExit(f"error: gnuplot failed: {result.stderr.strip()}")


def main() -> None:
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        raise SystemExit(f"usage: {__doc__}")
    FOLDER.mkdir(parents=True, exist_ok=True)
    files = []
    for bins in FWHM_BINS:
        files.append(FOLDER / f"fwhm{bins}.toml")
        files[-1].write_text(sensor_of(bins, PRESET.read_text(encoding="utf-8")), encoding="utf-8")
    command = [sys.argv[1], "scenes", "--sensor", *map(str, files), "--klux", *LIGHTS, "--readout", ",".join(READOUTS), "--variant",
               *(f"{name}:{WINDOWS_FOR_45.strip()}" for name in POOLED), "--scene", *SCENES, "--columns", str(COLUMNS), "--out", str(FOLDER), *sys.argv[2:]]
    result = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
    if result.returncode != 0:
        raise SystemExit(result.returncode)
    figures = read(FOLDER / "scenes.csv")
    draw(figures, FOLDER / "pulse_widths.svg")
    (FOLDER / "pulse_widths.csv").write_text(table_csv(figures), encoding="utf-8")
    text = f"""# Pulses of other widths

The preset thesis with pulses of {FWHM_BINS[0]} to {FWHM_BINS[-1]} bins (FWHM) of the same energy; {COLUMNS} columns of each scene
({', '.join(SCENES[1:])}), one seed, look-up tables of each read-out for its pulse. hisPointer's GUARD follows the
pulse; the matched filters know it. poolPointer's CELL_SHIFT follows it, too: the windows of a pointer that has settled,
and for 90 bins S1's reach. Other rows have the windows for 45 bins whatever the pulse. The candidates' windows are coarse
bins, which do not follow: they let more background in than a short pulse must have.

![Pixels above 3 % over the pulse's width](pulse_widths.svg)

{tables(figures)}
Command: `make pulse-widths`
"""
    (FOLDER / "pulse_widths.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    program.run(main)
