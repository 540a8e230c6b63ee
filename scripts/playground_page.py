#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes build/playground/index.html: page, style, worker and WebAssembly module in one file that opens without a server.

Area and power are those of the committed reports (`make synth`, `make power`), colours those of all pictures.
"""

import csv
import json
from pathlib import Path

import plot_style
from dtof_synth import program
from dtof_synth.configuration import load
from figures import store

ROOT = Path(__file__).resolve().parent.parent
PARTS = ROOT / "app" / "playground" / "page"
OUT = ROOT / "build" / "playground"
MODULE = OUT / "cmake" / "bin" / "playground_module.js"
SCRIPTS = ("page.js", "compare.js", "pixel.js", "files.js", "advice.js", "begin.js")  # of the page, in this order
THESIS_PIXELS = 32000


def rows(path: str) -> list[dict[str, str]]:
    with open(ROOT / path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def cost() -> dict[str, object]:
    """Area and power of each read-out's own configuration."""
    area = {row["configuration"]: row for row in rows("reports/area.csv")}
    measured = store.load(ROOT)
    readouts: dict[str, dict[str, object]] = {}
    smaller = []
    styles = plot_style.load()
    for name, configuration in load(ROOT / "configurations.toml").items():
        if configuration.variant_of or name not in area:
            continue
        size = int(area[name]["columns"]) * configuration["PIXELS_PER_SRAM"]
        if size != THESIS_PIXELS:
            columns, rows_a_column = area[name]["columns"], configuration["PIXELS_PER_SRAM"]
            smaller.append(f"* {configuration.title}: of {columns} x {rows_a_column} pixels.")
        readouts[area[name]["readout"]] = {
            "mm2": f"{float(area[name]['total_mm2']):.2f}",
            "mw": store.text(f"power.{name}.day_mw:.0f", measured),
            "bits": area[name]["bits_per_pixel"],
            "note": size != THESIS_PIXELS,
            "colour": plot_style.style(configuration.title, styles).colour,
        }
    note = ("Area and power (room at 50 klux) are those of an array of 200 x 160 pixels at 330 MHz in a generated 40 nm library, "
            "whatever is chosen above (reports/area.md, reports/power.md); no sign-off. " + " ".join(smaller))
    return {"readouts": readouts, "note": note}


def script(text: str, what: str) -> str:
    """A text that may stand inside <script>."""
    if "</script" in text.lower() or "<!--" in text:
        raise SystemExit(f"error: {what} would end the script that it stands in")
    return text


def page(module: str) -> str:
    """The page around the text of the WebAssembly module."""
    text = (PARTS / "page.html").read_text(encoding="utf-8")
    worker = module + "\n" + (PARTS / "worker.js").read_text(encoding="utf-8")
    for mark, part in {
        "/*STYLE*/": (PARTS / "style.css").read_text(encoding="utf-8").strip(),
        "/*COST*/": json.dumps(cost()),
        "/*PAGE*/": "\n".join(script((PARTS / name).read_text(encoding="utf-8"), name) for name in SCRIPTS),
        "/*WORKER*/": script(worker, "the module"),
    }.items():
        before, after = text.split(mark)
        text = before + part + after
    return text


def main() -> int:
    text = page(MODULE.read_text(encoding="utf-8"))
    (OUT / "index.html").write_text(text, encoding="utf-8")
    print(f"build/playground/index.html: {len(text.encode()) / 1e6:.1f} MB, opens in a browser as it is")
    return 0


if __name__ == "__main__":
    program.run(main)
