#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""How a read-out (readouts.toml) or reference (plot_styles.toml) looks in every picture. As a program: the styles as
elements of a C++ array, for CMake."""

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

from dtof_synth import program, readouts

FILE = Path(__file__).resolve().parent / "plot_styles.toml"


@dataclass(frozen=True)
class Style:
    title: str
    colour: str
    marker: int  # gnuplot's pointtype
    dash: int  # gnuplot's dashtype

    def points(self) -> str:
        return f"pointtype {self.marker} linecolor rgb '{self.colour}'"

    def lines(self) -> str:
        return f"{self.points()} dashtype {self.dash}"


def of_readout(title: str, entry: dict[str, str | int]) -> Style:
    return Style(title, str(entry["colour"]), int(entry["marker"]), int(entry["dash"]))


def load(file: Path = FILE) -> list[Style]:
    """Styles of the read-outs, then those in `file`."""
    of_readouts = [of_readout(readout.title, readout.style) for readout in readouts.load().readouts.values()]
    with file.open("rb") as opened:
        return of_readouts + [Style(**entry) for entry in tomllib.load(opened)["style"]]


def style(label: str, styles: list[Style]) -> Style:
    """Style with the longest title that begins the label."""
    found = [one for one in styles if label == one.title
             or label.startswith(one.title) and not label[len(one.title)].isalnum()]
    if not found:
        raise SystemExit(f"error: {label} has no style in readouts.toml or scripts/{FILE.name}")
    return max(found, key=lambda one: len(one.title))


def main() -> None:
    for one in load():
        print(f"    {{{json.dumps(one.title)}, {json.dumps(one.colour)}, {one.marker}, {one.dash}}},")


if __name__ == "__main__":
    program.run(main)
