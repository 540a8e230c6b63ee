# SPDX-License-Identifier: Apache-2.0
"""reports/sram.md: every macro in use, and the model compared with public points if they are present."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from statistics import mean

from . import sram_model, wide_words
from .sram_model import LinearInBits, PowerLaw, Size

CACTI_CELLS = "itrs-lstp"


def _row(size: Size, users: list[str], named: set[str]) -> str:
    macro = sram_model.macro(size)
    mine = [name for name in users if name in named]
    text = ", ".join(mine) if mine else "sweeps only"
    return (f"| {size.name} | {macro.organisation()} | {macro.width:.1f} x {macro.height:.1f} | {macro.area:.0f} | "
            f"{macro.area / size.capacity:.3f} | {macro.access_typical:.2f} | {macro.access_slow:.2f} | "
            f"{macro.read_energy:.2f} | {macro.write_energy:.2f} | {text} |")


def _read(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def cacti_points(pdk: Path, ports: int) -> list[dict[str, str]]:
    """The 40 nm low-standby-power points of a port kind."""
    wanted = ("1", "0", "0") if ports == 1 else ("0", "1", "1")
    return [row for row in _read(pdk / "sram_points" / "cacti7_1r1w.csv")
            if row["tech_nm"] == "40" and row["cell"] == CACTI_CELLS and (row["rw"], row["r"], row["w"]) == wanted]


def _range(ratios: list[float]) -> str:
    return f"{min(ratios):.2f} to {max(ratios):.2f}"


def fit(rows: Sequence[tuple[float, ...]], values: list[float]) -> list[float]:
    """Least squares of values = rows times the result, by the normal equations."""
    size = len(rows[0])
    matrix = [[sum(row[i] * row[j] for row in rows) for j in range(size)]
              + [sum(row[i] * value for row, value in zip(rows, values))] for i in range(size)]
    for i in range(size):
        for k in range(size):
            if k != i:
                factor = matrix[k][i] / matrix[i][i]
                matrix[k] = [x - factor * y for x, y in zip(matrix[k], matrix[i])]
    return [matrix[i][size] / matrix[i][i] for i in range(size)]


def fit_power_law(points: list[tuple[int, int, float]]) -> PowerLaw:
    """Fits log(value) = a + b log(words) + c log(bits) by least squares to points (words, bits, value)."""
    a, b, c = fit([(1.0, math.log(words), math.log(bits)) for words, bits, _ in points],
                  [math.log(value) for *_, value in points])
    return PowerLaw(math.exp(a), b, c)


def fit_linear_in_bits(points: list[tuple[int, int, float]]) -> LinearInBits:
    """Fits log(value) = a + b log(words) + log(bits + offset) by least squares; the offset by a ternary search."""
    def best(offset: float) -> tuple[float, float, float]:
        rows = [(1.0, math.log(words)) for words, _, _ in points]
        logs = [math.log(value / (bits + offset)) for _, bits, value in points]
        a, b = fit(rows, logs)
        return sum((a + b * row[1] - log) ** 2 for row, log in zip(rows, logs)), a, b

    low, high = 0.0, 64.0
    while high - low > 1e-6:
        left, right = low + (high - low) / 3, high - (high - low) / 3
        if best(left)[0] < best(right)[0]:
            high = right
        else:
            low = left
    _, a, b = best(low)
    return LinearInBits(math.exp(a), b, low)


def _extrapolated(rows: list[dict[str, str]], most_bits: int) -> tuple[float, float]:
    """Read energy of the widest words relative to CACTI's, by laws fitted to words of at most `most_bits`: (linear, power)."""
    points = [(int(row["words"]), int(row["bits"]), float(row["read_pJ"])) for row in rows]
    known = [point for point in points if point[1] <= most_bits]
    words, bits, energy = max(points, key=lambda point: point[1])
    return fit_linear_in_bits(known)(words, bits) / energy, fit_power_law(known)(words, bits) / energy


def _cacti_lines(pdk: Path) -> list[str]:
    lines = ["### CACTI 7, 40 nm, low standby power", "",
             "Area, access time over the anchor's and read energy of the model, divided by CACTI's.", "",
             "| size | area | access | read energy |", "|---|---:|---:|---:|"]
    areas: dict[int, list[float]] = {1: [], 2: []}
    energies: dict[int, list[float]] = {1: [], 2: []}
    for ports in (1, 2):
        points = cacti_points(pdk, ports)
        kind = sram_model.KINDS[ports]
        for point in points:
            size = Size(ports, int(point["words"]), int(point["bits"]))
            macro = sram_model.macro(size)
            area = macro.area / float(point["area_um2"])
            access = kind.access(size.words, size.bits) / float(point["access_ns"])
            energy = macro.read_energy / float(point["read_pJ"])
            areas[ports].append(area)
            energies[ports].append(energy)
            lines.append(f"| {size.name} | {area:.2f} | {access:.2f} | {energy:.2f} |")
    lines += ["", f"Mean area ratio: one port {mean(areas[1]):.2f}, two ports {mean(areas[2]):.2f}. CACTI's arrays carry "
              "no power ring, test logic or margin, so compiled macros are larger; its small arrays most of all.",
              "", f"Read energy: one port {_range(energies[1])}, two ports {_range(energies[2])} of CACTI's, in words of up "
              "to 64 bits. Wider words are extrapolated, linearly in the bits; how well that does is what laws that were fitted "
              "to narrower words alone make of wider ones:", "",
              "| | fitted to | of 64 bits, linear in bits | of 64 bits, power law |", "|---|---|---:|---:|"]
    lines += [f"| {title} | at most {most} bits | {linear:.2f} | {power:.2f} |"
              for ports, title in ((1, "one port"), (2, "two ports")) for most in (16, 32)
              for linear, power in [_extrapolated(cacti_points(pdk, ports), most)]]
    return lines


def _openram_lines(pdk: Path) -> list[str]:
    lines = ["### OpenRAM FreePDK45, scaled by (40/45)^2", "",
             "Its bank drawn with 45 nm logic rules; the model takes its strips and foundry bitcells.", "",
             "| size | OpenRAM macro um2 | bank um2 | model um2 | model / bank |", "|---|---:|---:|---:|---:|"]
    shrink = (40 / 45) ** 2
    for row in _read(pdk / "sram_points" / "openram_freepdk45.csv"):
        size = Size(1 if row["ports"] == "1rw" else 2, int(row["words"]), int(row["bits"]))
        bank = float(row["bank_um2"]) * shrink
        model = sram_model.macro(size).area
        lines.append(f"| {size.name} | {float(row['macro_um2']) * shrink:.0f} | {bank:.0f} | {model:.0f} | "
                     f"{model / bank:.2f} |")
    return lines


def _straight_line(points: list[tuple[float, float]]) -> tuple[float, float, float]:
    """(offset, slope, largest relative error) of a straight line through points."""
    mean_x, mean_y = mean(x for x, _ in points), mean(y for _, y in points)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)
    offset = mean_y - slope * mean_x
    return offset, slope, max(abs((offset + slope * x) / y - 1) for x, y in points)


def _ihp_lines(pdk: Path) -> list[str]:
    rows = _read(pdk / "sram_points" / "ihp130_1p.csv")
    width = _straight_line([(float(row["cols"]), float(row["w_um"])) for row in rows])
    height = _straight_line([(float(row["rows"]), float(row["h_um"])) for row in rows])
    slow = [float(row["clk2q_slow_ns"]) / float(row["clk2q_typ_ns"]) for row in rows if row["clk2q_slow_ns"]]
    return ["### IHP 130 nm compiled macros", "",
            f"Width = {width[0]:.1f} + {width[1]:.3f} x columns um (largest error {width[2]:.1%}), height = "
            f"{height[0]:.1f} + {height[1]:.3f} x rows um ({height[2]:.1%}): the form of the model holds for "
            f"compiled macros. Slow over typical clock-to-data: {min(slow):.2f} to {max(slow):.2f}; "
            f"here {sram_model.ACCESS_SLOW_NS / sram_model.ACCESS_TYPICAL_NS:.2f}."]


def text(uses: dict[Size, list[str]], named: set[str], pdk: Path) -> str:
    """The report; without the public points only the list of macros."""
    lines = ["# SRAM macros", "",
             "Written by `make synth` from the physical model of `synth/dtof_synth/sram_model.py`; "
             "[docs/reference/technology.md](../docs/reference/technology.md) has the sources. Not sign-off.", "",
             "| macro | organisation | um x um | um2 | um2/bit | access typ ns | slow ns | read pJ | write pJ | used by |",
             "|---|---|---:|---:|---:|---:|---:|---:|---:|---|",
             *(_row(size, uses[size], named) for size in sorted(uses)), ""]
    if (pdk / "sram_points").is_dir():
        lines += ["## Beside public points", "", *_cacti_lines(pdk), "", *wide_words.lines(), "", *_openram_lines(pdk), "",
                  *_ihp_lines(pdk), ""]
    else:
        lines += ["## Beside public points", "", *wide_words.lines(), "",
                  "The public points (CACTI, OpenRAM, IHP) are not beside this checkout; no comparison.", ""]
    return "\n".join(lines)
