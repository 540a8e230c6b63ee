# SPDX-License-Identifier: Apache-2.0
"""The main job's figures: accuracy of the frame beside measured area, power and memory (reports/figures.json)."""

import csv
from dataclasses import dataclass
from pathlib import Path

from dtof_synth.configuration import load
from figures import store

NOT_MADE = "-"


@dataclass(frozen=True)
class ReadoutFigures:
    title: str
    name: str  # of its files
    above_3: str
    above_10: str
    rmse_mm: str
    mm2: str
    mw: str  # by day, from the activity of the netlist
    bits: str


def rows(path: Path) -> list[dict[str, str]]:
    if not path.is_file():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def figures(root: Path, frame: Path) -> list[ReadoutFigures]:
    """One entry for each row of the frame's summary.csv, in its order."""
    measured = store.load(root)

    def text(reference: str) -> str:
        return store.text(reference, measured) if reference.partition(":")[0] in measured else NOT_MADE

    configurations = {configuration.title: (name, configuration)
                      for name, configuration in load(root / "configurations.toml").items()
                      if not configuration.variant_of}
    found = []
    for row in rows(frame / "summary.csv"):
        name, configuration = configurations[row["read-out"]]
        mm2 = text(f"area.{name}.array_mm2:.2f")
        if mm2 != NOT_MADE and configuration.pixels != 32000:
            mm2 += f" ({configuration['SRAM_NUM']} x {configuration['PIXELS_PER_SRAM']} pixels)"
        found.append(ReadoutFigures(row["read-out"], configuration.readout, row["above 3 %"], row["above 10 %"], row["rmse mm"],
                                    mm2, text(f"power.{name}.day_mw:.0f"), text(f"area.{name}.bits_per_pixel")))
    return found
