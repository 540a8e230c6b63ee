# SPDX-License-Identifier: Apache-2.0
"""The main job's figures: accuracy of the frame beside area, power and memory of the synthesis."""

import csv
import sys
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "synth"))

from dtof_synth.configuration import load  # noqa: E402

NOT_MADE = "-"


@dataclass(frozen=True)
class ReadoutFigures:
    title: str
    name: str  # of its files
    above_3: str
    above_10: str
    rmse_mm: str
    mm2: str
    mw: str
    bits: str


def rows(path: Path) -> list[dict[str, str]]:
    if not path.is_file():
        return []
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def figures(root: Path, frame: Path) -> list[ReadoutFigures]:
    """One entry for each row of the frame's summary.csv, in its order."""
    area = {row["configuration"]: row for row in rows(root / "reports/area.csv")}
    power = {row["configuration"]: row for row in rows(root / "reports/timing.csv") if row["corner"] == "typical"}
    configurations = {configuration.title: (name, configuration)
                      for name, configuration in load(root / "configurations.toml").items()
                      if not configuration.variant_of}
    found = []
    for row in rows(frame / "summary.csv"):
        name, configuration = configurations[row["read-out"]]
        mm2 = mw = bits = NOT_MADE
        if name in area:
            columns = int(area[name]["columns"])
            mm2 = f"{float(area[name]['total_mm2']):.2f}"
            bits = area[name]["bits_per_pixel"]
            if columns * configuration["PIXELS_PER_SRAM"] != 32000:
                mm2 += f" ({columns} x {configuration['PIXELS_PER_SRAM']} pixels)"
        if name in power:
            mw = f"{sum(float(power[name][part]) for part in ('logic_mw', 'sram_mw', 'clock_mw')):.0f}"
        found.append(ReadoutFigures(row["read-out"], configuration.readout, row["above 3 %"], row["above 10 %"],
                                    row["rmse mm"], mm2, mw, bits))
    return found
