# SPDX-License-Identifier: Apache-2.0
"""reports/sram.md: every macro in use, and the model beside public points where they are present."""

from __future__ import annotations

import csv
from pathlib import Path
from statistics import mean

from . import sram_model
from .sram_model import Size

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


def _cacti_lines(pdk: Path) -> list[str]:
    lines = ["### CACTI 7, 40 nm, low standby power", "",
             "Area, access time over the anchor's and read energy of the model, divided by CACTI's.", "",
             "| size | area | access | read energy |", "|---|---:|---:|---:|"]
    areas: dict[int, list[float]] = {1: [], 2: []}
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
            lines.append(f"| {size.name} | {area:.2f} | {access:.2f} | {energy:.2f} |")
    lines += ["", f"Mean area ratio: one port {mean(areas[1]):.2f}, two ports {mean(areas[2]):.2f}. CACTI's arrays carry "
              "no power ring, test logic or margin, so compiled macros are larger; its small arrays most of all."]
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


def _fit(points: list[tuple[float, float]]) -> tuple[float, float, float]:
    """(offset, slope, largest relative error) of a straight line."""
    mean_x, mean_y = mean(x for x, _ in points), mean(y for _, y in points)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)
    offset = mean_y - slope * mean_x
    return offset, slope, max(abs((offset + slope * x) / y - 1) for x, y in points)


def _ihp_lines(pdk: Path) -> list[str]:
    rows = _read(pdk / "sram_points" / "ihp130_1p.csv")
    width = _fit([(float(row["cols"]), float(row["w_um"])) for row in rows])
    height = _fit([(float(row["rows"]), float(row["h_um"])) for row in rows])
    slow = [float(row["clk2q_slow_ns"]) / float(row["clk2q_typ_ns"]) for row in rows if row["clk2q_slow_ns"]]
    return ["### IHP 130 nm compiled macros", "",
            f"Width = {width[0]:.1f} + {width[1]:.3f} x columns um (largest error {width[2]:.1%}), height = "
            f"{height[0]:.1f} + {height[1]:.3f} x rows um ({height[2]:.1%}): the form of the model holds for "
            f"compiled macros. Slow over typical clock-to-data: {min(slow):.2f} to {max(slow):.2f}; "
            f"here {sram_model.ACCESS_SLOW_NS / sram_model.ACCESS_TYPICAL_NS:.2f}."]


def text(uses: dict[Size, list[str]], named: set[str], pdk: Path) -> str:
    """The report. Without the public points only the list of macros."""
    lines = ["# SRAM macros", "",
             "Written by `make synth` from the physical model of `synth/dtof_synth/sram_model.py`; "
             "[docs/reference/technology.md](../docs/reference/technology.md) has the sources. Not sign-off.", "",
             "| macro | organisation | um x um | um2 | um2/bit | access typ ns | slow ns | read pJ | write pJ | used by |",
             "|---|---|---:|---:|---:|---:|---:|---:|---:|---|",
             *(_row(size, uses[size], named) for size in sorted(uses)), ""]
    if (pdk / "sram_points").is_dir():
        lines += ["## Beside public points", "", *_cacti_lines(pdk), "", *_openram_lines(pdk), "",
                  *_ihp_lines(pdk), ""]
    else:
        lines += ["The public points (CACTI, OpenRAM, IHP) are not beside this checkout; no comparison.", ""]
    return "\n".join(lines)
