# SPDX-License-Identifier: Apache-2.0
"""Picture of several layouts side by side, to scale: cells, wires by layer, pins of the edge. Drawn by gnuplot."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import FlowError
from .block import SUPPLIES
from .results import Layout

GAP_UM = 30.0
BAR_UM = 100.0
WIDTH_PX = 1600
COLOURS = {"flip-flops": "#9db8d9", "logic": "#e3e3e3"}
LAYERS = {"metal1": "#5577cc", "metal2": "#cc3333", "metal3": "#2a9d4a", "metal4": "#c58a00", "metal5": "#8844aa",
          "metal6": "#008b8b"}
SRAM_PIN, OTHER_PIN = "#d00000", "#000000"


@dataclass(frozen=True)
class Drawn:
    """A layout and its caption."""

    title: str
    layout: Layout
    sram_ports: frozenset[str]
    sequential: frozenset[str]


def cell_sizes(lef: str) -> dict[str, tuple[float, float]]:
    """Width and height of every cell of a LEF, um."""
    found = re.findall(r"^MACRO (\S+).*?^\s*SIZE\s+(\S+) BY (\S+) ;", lef, re.DOTALL | re.MULTILINE)
    return {name: (float(width), float(height)) for name, width, height in found}


def _offsets(drawn: list[Drawn]) -> Iterator[float]:
    at = 0.0
    for one in drawn:
        yield at - one.layout.die[0]
        at += one.layout.die[2] - one.layout.die[0] + GAP_UM


def script(drawn: list[Drawn], sizes: dict[str, tuple[float, float]], output: Path) -> str:
    boxes: dict[str, list[str]] = {colour: [] for colour in COLOURS.values()}
    lines: dict[str, list[str]] = {layer: [] for layer in LAYERS}
    pins: dict[str, list[str]] = {OTHER_PIN: [], SRAM_PIN: []}
    frames: list[str] = []
    labels: list[str] = []
    top = max(one.layout.die[3] for one in drawn)
    right = 0.0
    for one, offset in zip(drawn, _offsets(drawn)):
        left, low, end, high = one.layout.die
        right = offset + end
        frames.append(f"{offset + left} {low} {end - left} 0\n{offset + end} {low} 0 {high - low}\n"
                      f"{offset + left} {high} {end - left} 0\n{offset + left} {low} 0 {high - low}")
        labels.append(f"set label '{one.title}' at {offset + left},{high} left offset 0,0.8 font ',13' noenhanced")
        labels.append(f"set label '{end - left:.0f} x {high - low:.0f} um, {_cells(one)} cells' at {offset + left},{low} "
                      "left offset 0,-0.9 noenhanced")
        for kind, x, y in one.layout.cells.values():
            if kind != "FILL":
                width, height = sizes[kind]
                colour = COLOURS["flip-flops" if kind in one.sequential else "logic"]
                boxes[colour].append(f"{offset + x + width / 2} {y + height / 2} {width / 2 - 0.15} {height / 2 - 0.5}")
        for wires in one.layout.wires.values():
            for wire in wires:
                for (x0, y0), (x1, y1) in zip(wire.points, wire.points[1:]):
                    lines[wire.layer].append(f"{offset + x0} {y0} {x1 - x0} {y1 - y0}")
        for net, (x, y) in one.layout.pins.items():
            if net not in SUPPLIES:
                pins[SRAM_PIN if net in one.sram_ports else OTHER_PIN].append(f"{offset + x} {y}")
    blocks: list[str] = []
    plots: list[str] = []

    def series(data: list[str], how: str) -> None:
        if data:
            blocks.append(f"$d{len(blocks)} << EOD\n" + "\n".join(data) + "\nEOD")
            plots.append(f"$d{len(blocks) - 1} {how}")

    for name, colour in COLOURS.items():
        series(boxes[colour], f"with boxxyerror fillstyle solid noborder linecolor rgb '{colour}' title '{name}'")
    for layer, colour in LAYERS.items():
        series(lines[layer], f"with vectors nohead linewidth 0.6 linecolor rgb '{colour}' title '{layer}'")
    series(pins[SRAM_PIN], f"with points pointtype 7 pointsize 0.4 linecolor rgb '{SRAM_PIN}' title 'pins to the SRAM'")
    series(pins[OTHER_PIN], f"with points pointtype 7 pointsize 0.4 linecolor rgb '{OTHER_PIN}' title 'other pins'")
    series(frames, "with vectors nohead linecolor rgb '#000000' notitle")
    band = top + 35  # scale and key, above the titles
    series([f"0 {band} {BAR_UM} 0"], "with vectors nohead linewidth 3 linecolor rgb '#000000' notitle")
    labels.append(f"set label '{BAR_UM:.0f} um' at {BAR_UM / 2},{band} center offset 0,0.8")
    height = round(WIDTH_PX * (band + 60) / right)
    head = [f"set terminal png size {WIDTH_PX},{height} font 'DejaVu Sans,11'", f"set output '{output}'",
            "unset border", "unset tics", "set size ratio -1", "set lmargin 0", "set rmargin 0", "set tmargin 0",
            "set bmargin 0", f"set xrange [-5:{right + 5}]", f"set yrange [-30:{band + 30}]",
            f"set key at {BAR_UM + 20},{band + 25} left top Left reverse vertical maxrows 3 samplen 2 width 1"]
    return "\n".join(blocks + head + labels + ["plot " + ", ".join(plots), ""])


def _cells(one: Drawn) -> str:
    return f"{sum(kind != 'FILL' for kind, _, _ in one.layout.cells.values()):,}"


def draw(drawn: list[Drawn], sizes: dict[str, tuple[float, float]], output: Path) -> None:
    finished = subprocess.run(["gnuplot"], input=script(drawn, sizes, output), text=True, capture_output=True, check=False)
    if finished.returncode != 0:
        raise FlowError(f"gnuplot: {finished.stderr.strip()}")
