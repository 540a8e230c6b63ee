# SPDX-License-Identifier: Apache-2.0
"""Elaborated netlists without names from the source, so that equal logic is always synthesised in the same way.

Yosys derives private names from file names, lines and a running number. Its passes and ABC depend on names and their order, so a comment in
one file would change the area of every read-out by some per cent. Therefore private names become numbers, and attributes that only tell the
origin are dropped.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

_NAMED = re.compile(r"^  (wire|cell) (?:.* )?([$\\]\S+)$")
_PRIVATE = re.compile(r"(?<= )\$\S+")
_LINE_OF_SOURCE = re.compile(r"(?<=\.)(s?vh?|cc):[\d.:-]+")
_ORIGIN = re.compile(r"^ *attribute \\(src|hdlname) ")
_RUNNING_NUMBER = re.compile(r"^autoidx \d+$", re.MULTILINE)


@dataclass(frozen=True)
class _Block:
    """A statement of a module with the attributes before it. `name`: of a wire or a cell, else empty."""

    kind: str  # wire, cell, parameter or connect
    name: str
    lines: list[str]


def _blocks(lines: list[str]) -> list[_Block]:
    blocks: list[_Block] = []
    gathered: list[str] = []
    kind = name = ""
    for line in lines:
        gathered.append(line)
        if line.startswith("  attribute "):
            continue
        if not kind:
            named = _NAMED.match(line)
            kind, name = named.groups() if named else (line.split()[0], "")
        if kind != "cell" or line == "  end":
            blocks.append(_Block(kind, name, gathered))
            gathered, kind, name = [], "", ""
    return blocks


def _running_order(block: _Block) -> list[tuple[int, int, str]]:
    """Sort key by text and by the numbers in it, so that names from Yosys keep the order in which Yosys made them."""
    parts = re.split(r"(\d+)", _LINE_OF_SOURCE.sub(r"\1", block.name))
    return [(1, int(part), "") if part.isdigit() else (0, 0, part) for part in parts]


def _module(lines: list[str]) -> list[str]:
    """Sorts a module: cells by name, wires in the order in which cells name them."""
    blocks = _blocks(lines)
    of_kind = {kind: [block for block in blocks if block.kind == kind] for kind in ("parameter", "wire", "cell", "connect")}
    cells = sorted(of_kind["cell"], key=_running_order)
    private = {block.name for block in of_kind["wire"] if block.name.startswith("$")}
    used = dict.fromkeys(found for block in cells + of_kind["connect"] for line in block.lines if not line.startswith("  cell ")
                         for found in _PRIVATE.findall(line) if found in private)
    new_name = {name: f"$wire{number:06d}" for number, name in enumerate(used)}
    new_name |= {block.name: f"$cell{number:06d}" for number, block in enumerate(cells) if block.name.startswith("$")}
    wires = sorted((block for block in of_kind["wire"] if block.name not in private or block.name in used),
                   key=lambda block: new_name.get(block.name, block.name))
    return [_PRIVATE.sub(lambda found: new_name.get(found.group(), found.group()), line)
            for block in of_kind["parameter"] + wires + cells + of_kind["connect"] for line in block.lines]


def canonical(text: str, root: Path) -> str:
    """The netlist (RTLIL) without traces of the source, which is below `root`. One trace remains: names of variables in functions keep the
    line of the call."""
    lines = [line for line in text.replace(str(root), "").splitlines() if not _ORIGIN.match(line)]
    written: list[str] = []
    index = 0
    while index < len(lines):
        written.append(lines[index])
        if lines[index].startswith("module "):
            end = lines.index("end", index)
            written += [*_module(lines[index + 1:end]), "end"]
            index = end
        index += 1
    return _RUNNING_NUMBER.sub("autoidx 1000000", "\n".join(written)) + "\n"
