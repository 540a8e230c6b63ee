# SPDX-License-Identifier: Apache-2.0
"""Reads and judges the output of the layout tools. A tool without output has failed, whatever its exit status."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field

from ..errors import FlowError

Point = tuple[float, float]


def failed_nets(log: str) -> list[str]:
    """Nets that qrouter could not route, from the whole log. The last count in the log is valid."""
    last = re.findall(r"^Final: (No failed routes!|Failed net routes: \d+)", log, re.MULTILINE)
    if not last:
        raise FlowError("the router did not come to its end")
    if last[-1].startswith("No"):
        return []
    names = re.findall(r"^ (\S+)$", log.split("List of failed nets follows:")[-1], re.MULTILINE)
    number = int(last[-1].split()[-1])
    return (names + ["unnamed"] * number)[:number]


@dataclass(frozen=True)
class Violations:
    """Design rule errors: their number, and the boxes of each rule in the layout's micrometres."""

    total: int
    boxes: dict[str, list[tuple[float, ...]]]


def violations(output: str) -> Violations:
    """Design rule errors in the output of magic.tcl, whose boxes are in tenths of a micrometre (lambda)."""
    total = re.findall(r"^DTOF_DRC (\d+)$", output, re.MULTILINE)
    if not total or "DTOF_MAGIC_OK" not in output:
        raise FlowError("Magic did not come to the end of its script")
    boxes: dict[str, list[tuple[float, ...]]] = {}
    for where, why in re.findall(r"^DTOF_BOX \{?([-\d. ]+)\}? (.*)$", output, re.MULTILINE):
        boxes.setdefault(why, []).append(tuple(float(number) / 10 for number in where.split()))
    return Violations(int(total[-1]), boxes)


UNIQUE = "Circuits match uniquely."


def lvs_verdict(output: str) -> str:
    """Netgen's last verdict; only UNIQUE is a match."""
    verdicts = re.findall(r"^Result: (.*)$", output, re.MULTILINE)
    if not verdicts:
        raise FlowError("Netgen came to no result")
    return verdicts[-1].strip()


@dataclass
class Wire:
    """A piece of a net: its layer and corners in um."""

    layer: str
    points: list[Point]

    @property
    def length(self) -> float:
        return sum(abs(a[0] - b[0]) + abs(a[1] - b[1]) for a, b in zip(self.points, self.points[1:]))


@dataclass
class Layout:
    """A routed DEF in um: die, positions of cells and pins, wires by net."""

    die: tuple[float, float, float, float]
    cells: dict[str, tuple[str, float, float]]
    pins: dict[str, Point]
    wires: dict[str, list[Wire]] = field(default_factory=dict)

    @property
    def die_area(self) -> float:
        left, low, right, high = self.die
        return (right - left) * (high - low)

    def length(self, net: str) -> float:
        return sum(wire.length for wire in self.wires.get(net, []))


def _section(text: str, name: str) -> str:
    found = re.search(rf"^{name} \d+ ;$(.*?)^END {name}$", text, re.DOTALL | re.MULTILINE)
    return found.group(1) if found else ""


def _wires(text: str, scale: float) -> Iterator[Wire]:
    for piece in re.split(r"\bNEW\b", text):
        words = piece.split()
        points: list[Point] = []
        for x, y in re.findall(r"\( (\S+) (\S+)[^)]*\)", piece):
            points.append((points[-1][0] if x == "*" else float(x) / scale,
                           points[-1][1] if y == "*" else float(y) / scale))
        if words and points:
            yield Wire(words[0], points)


def read_def(text: str) -> Layout:
    """Reads a routed DEF. Special nets hold the supplies and, for signals, the router's widened stubs inside pins, whose length is not
    counted."""
    units = re.search(r"^UNITS DISTANCE MICRONS (\d+) ;$", text, re.MULTILINE)
    die = re.search(r"^DIEAREA \( (\S+) (\S+) \) \( (\S+) (\S+) \) ;$", text, re.MULTILINE)
    components = re.findall(r"^- (\S+) (\S+) \+ PLACED \( (\S+) (\S+) \)", _section(text, "COMPONENTS"), re.MULTILINE)
    if not units or not die or not components:
        raise FlowError("the DEF has no units, no die or no cells")
    scale = float(units.group(1))
    pins = re.findall(r"^- \S+ \+ NET (\S+)\n(?:.*\n)  \+ PLACED \( (\S+) (\S+) \)", _section(text, "PINS"), re.MULTILINE)
    left, bottom, right, top = (float(edge) / scale for edge in die.groups())
    layout = Layout((left, bottom, right, top),
                    {name: (kind, float(x) / scale, float(y) / scale) for name, kind, x, y in components},
                    {net: (float(x) / scale, float(y) / scale) for net, x, y in pins})
    for net, body in re.findall(r"^- (\S+)\s*$(.*?);\s*$", _section(text, "NETS"), re.DOTALL | re.MULTILINE):
        layout.wires[net] = list(_wires(body.split("+ ROUTED", 1)[1], scale)) if "+ ROUTED" in body else []
    return layout


@dataclass
class Branch:
    """A piece of a net with its resistance in ohm. `pins`: `cell/pin` or a port at its end."""

    ohm: float
    weight: float
    pins: list[str] = field(default_factory=list)
    branches: list[Branch] = field(default_factory=list)


@dataclass
class Tree:
    """A net as the router wrote it: the driving pin and the branches from it."""

    driver: str
    branches: list[Branch]


# A net's tree is read and walked recursively, and may be as deep as the net has pieces.
sys.setrecursionlimit(100_000)


def read_trees(text: str) -> dict[str, Tree]:
    """Reads qrouter's file of nested resistances and capacitances (`net 1 driver sinks (R C end , end)`). For a net whose pieces form a
    loop the router writes a pin ERROR; such a net is left out."""
    trees = {}
    for number, line in enumerate(text.splitlines(), 1):
        words = line.replace("PIN/", "").split()
        if not words or "ERROR" in words:
            continue
        try:
            ends = _Ends(words[4:])
            trees[words[0]] = Tree(words[2], ends.read().branches)
        except (IndexError, ValueError):
            raise FlowError(f"the router's list of resistances breaks off in line {number}") from None
    return trees


class _Ends:
    def __init__(self, words: list[str]) -> None:
        self.words = words
        self.at = 0

    def read(self) -> Branch:
        """Reads branches up to a closing bracket or the end of the line."""
        found = Branch(0.0, 0.0)
        while self.at < len(self.words) and self.words[self.at] != ")":
            word = self.words[self.at]
            self.at += 1
            if word == "(":
                ohm, weight = float(self.words[self.at]), float(self.words[self.at + 1])
                self.at += 2
                inner = self.read()
                if self.words[self.at] != ")":
                    raise ValueError
                self.at += 1
                found.branches.append(Branch(ohm, weight, inner.pins, inner.branches))
            elif word != ",":
                found.pins.append(word)
        return found


@dataclass(frozen=True)
class Arrivals:
    """Longest path, and mean of the longest paths to all ends, ns."""

    longest: float
    mean: float
    end: str


def arrivals(output: str, label: str, period: float) -> Arrivals:
    """Arrival times from OpenSTA's slacks of all ends under one label (layout.tcl)."""
    section = output.split(f"{label}\n", 1)[1].split("DTOF_", 1)[0] if f"{label}\n" in output else ""
    slacks = [(float(slack), end) for end, slack in re.findall(r"^(\S+) .* (-?\d+\.\d+) \((?:MET|VIOLATED)\)$", section,
                                                                       re.MULTILINE)]
    if not slacks:
        raise FlowError(f"OpenSTA reported no paths under {label}")
    worst, end = min(slacks)
    return Arrivals(period - worst, period - sum(slack for slack, _ in slacks) / len(slacks), end)
