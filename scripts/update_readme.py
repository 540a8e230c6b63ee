#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the results of README.md from reports/figures.json; --check only compares.

Every figure was printed by a command of this tree: areas and clock by `make synth`, power by `make power`, accuracy by `make frames`,
or by `make` until the standard frames are measured.
"""

import sys
import textwrap
from pathlib import Path

from dtof_synth import program
from dtof_synth.configuration import Configuration, load
from figures import store

ROOT = Path(__file__).resolve().parent.parent
BEGIN = "<!-- results: written by scripts/update_readme.py -->\n"
END = "<!-- end of results -->"
NONE = "-"  # not measured
FRAMES = "frames.ezpointer."  # figures of the standard frames begin so, one for each sensor
ABOVE = "_above_3_percent"


class Results:
    """Figures by name, and the reports from which they come."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.figures = store.load(root)
        self.reports: set[str] = set()
        # Sensors of the standard frames. Before `make frames` has run it is the main job's frame.
        self.sensors = sorted(name.removeprefix(FRAMES).removesuffix(ABOVE) for name in self.figures
                              if name.startswith(FRAMES) and name.endswith(ABOVE))

    def text(self, reference: str) -> str:
        text = store.text(reference, self.figures)
        self.reports.add(self.figures[reference.partition(":")[0]].report)
        return text

    def optional(self, reference: str, unit: str = "") -> str:
        return self.text(reference) + unit if reference.partition(":")[0] in self.figures else NONE

    def row(self, name: str, one: Configuration) -> str:
        array = self.text(f"area.{name}.array_mm2:.2f")
        if one["SRAM_NUM"] * one["PIXELS_PER_SRAM"] != 32000:
            array += f" ({one['SRAM_NUM']} x {one['PIXELS_PER_SRAM']} pixels)"
        thesis = f"{one.thesis_mm2:g}" if one.thesis_mm2 else NONE
        cells = (one.title, array, self.optional(f"area.{name}.placed_with_scan_and_clock_tree_mm2:.2f"), thesis,
                 self.optional(f"power.{name}.day_mw:.0f"), self.text(f"area.{name}.bits_per_pixel"),
                 self.text(f"area.{name}.column_um2:.0f"), self.text(f"timing.{name}.slow_fmax_mhz:.0f"), *self.accuracy(name))
        return "| " + " | ".join(cells) + " |"

    def accuracy(self, name: str) -> tuple[str, ...]:
        references = [f"frames.{name}.{sensor}{ABOVE}" for sensor in self.sensors] or \
            [f"frame.{name}.above_3_percent", f"frame.{name}.above_10_percent"]
        return tuple(self.optional(reference, " %") for reference in references)

    def table(self) -> str:
        header = ("read-out", "mm2, 200 columns", "placed mm2", "thesis mm2", "mW by day", "bits a pixel", "logic um2 a column",
                  "fmax slow, MHz", *([f"pixels off by > 3 %: {sensor}" for sensor in self.sensors]
                                      or ["pixels off by > 3 %", "> 10 %"]))
        lines = ["| " + " | ".join(header) + " |", "|---|" + "---:|" * (len(header) - 1)]
        lines += [self.row(name, one) for name, one in load(self.root / "configurations.toml").items()
                  if not one.variant_of and f"area.{name}.array_mm2" in self.figures]
        return "\n".join(lines) + "\n"

    def scene(self) -> str:
        """Scene on which the table's accuracy was measured, from the page's line with its name."""
        page = (self.root / "reports" / ("frames.md" if self.sensors else "frame/summary.md")).read_text(encoding="utf-8")
        scene = next(line for line in page.splitlines() if line.startswith("Scene "))
        return ("\"Pixels off by > 3 %\" have a relative error above 3 %. Each read-out's look-up table, which is measured on flat targets, "
                f"has corrected the distances. {scene.removesuffix('.')}. The room has a sphere and boxes in front of walls, 0.8 to 5 m away. "
                "An acquisition is one laser pulse. Signal events are detected laser photons of a pixel whose target is R metres away. Models, "
                "exact photons: the C++ models read photons of the exact photon model.")

    def notes(self) -> list[str]:
        """What the columns of the table mean, and how their figures were measured."""
        return [
            "\"mm2\" is the area of cells and memories of the array, \"placed mm2\" the area after placement with scan and clock tree. Both "
            "come from generated 40 nm libraries and are no sign-off ([area](reports/area.md#placed)). \"Thesis mm2\" is the area that the "
            "thesis states. \"Bits a pixel\" is the memory of the array, \"fmax slow\" the highest clock in the slow corner.",
            "\"mW by day\" is the power while acquisitions of the room at 50 klux stream in, from the activity of the netlists "
            "([power](reports/power.md)).",
            self.scene(),
        ]

    def block(self) -> str:
        return "".join(filled(note) for note in self.notes()) + "\n" + self.table()


def filled(text: str) -> str:
    """An entry of a list in lines of the page's width."""
    return textwrap.fill(text, width=140, initial_indent="* ", subsequent_indent="  ", break_long_words=False, break_on_hyphens=False) + "\n"


def quoted_reports(root: Path) -> set[str]:
    """Reports whose figures stand in the results."""
    results = Results(root)
    results.block()
    return results.reports


def updated(text: str, root: Path = ROOT) -> str:
    head, rest = text.split(BEGIN)
    return head + BEGIN + Results(root).block() + END + rest.split(END)[1]


def write(check: bool = False) -> int:
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    if check and updated(text) != text:
        print("error: README.md: the results differ from reports/figures.json; run `make figures`", file=sys.stderr)
        return 1
    if not check:
        readme.write_text(updated(text), encoding="utf-8")
    return 0


if __name__ == "__main__":
    program.run(lambda: write(check="--check" in sys.argv[1:]))
