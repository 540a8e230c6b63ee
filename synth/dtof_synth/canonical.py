# SPDX-License-Identifier: Apache-2.0
"""Elaborated netlists without names from the source, so that equal logic is always synthesised in the same way.

Yosys derives private names from file names, lines and a running number, and the name of a module from all of its parameters. Its passes and ABC
depend on names and their order, so a comment in one file, or a parameter that changes nothing, would change the area of a read-out by some per
cent. Therefore private names become numbers, and modules follow each other as their instances do. Attributes that only tell the origin are
dropped, and so are the parameters of modules, whose values are in the logic.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

_NAMED = re.compile(r"^  (wire|cell) (?:.* )?([$\\]\S+)$")
_PRIVATE = re.compile(r"(?<= )(?:\$\S+|\\\S*\$func\$\S+)")  # the second kind: variables of a function, with the line of its call
_DERIVED = re.compile(r"\$paramod(?:\$[0-9a-f]+)?\\([a-z]\w*)")  # a module with parameters, whose values or their digest follow
_LINE_OF_SOURCE = re.compile(r"(?<=\.)(s?vh?|cc):[\d.:-]+")
_DROPPED = re.compile(r"^ *attribute \\(src|hdlname|nosync) ")  # the last one: of the variables of a function
_RUNNING_NUMBER = re.compile(r"^autoidx \d+$", re.MULTILINE)


@dataclass(frozen=True)
class _Block:
    """A statement of a module with the attributes before it. `name`: of a wire or a cell, else empty."""

    kind: str  # wire, cell, connect, or parameter, which is dropped
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
    """Sorts a module: cells by name, wires in the order in which cells name them, connections by their text: Yosys writes these in the order
    of a hash."""
    blocks = _blocks(lines)
    of_kind = {kind: [block for block in blocks if block.kind == kind] for kind in ("wire", "cell", "connect")}
    cells = sorted(of_kind["cell"], key=_running_order)
    private = {block.name for block in of_kind["wire"] if _PRIVATE.match(f" {block.name}", 1)}
    used = dict.fromkeys(found for block in cells + of_kind["connect"] for line in block.lines if not line.startswith("  cell ")
                         for found in _PRIVATE.findall(line) if found in private)
    new_name = {name: f"$wire{number:06d}" for number, name in enumerate(used)}
    new_name |= {block.name: f"$cell{number:06d}" for number, block in enumerate(cells) if block.name.startswith("$")}
    wires = sorted((block for block in of_kind["wire"] if block.name not in private or block.name in used),
                   key=lambda block: new_name.get(block.name, block.name))

    def renamed(blocks: list[_Block]) -> list[str]:
        return [_PRIVATE.sub(lambda found: new_name.get(found.group(), found.group()), line) for block in blocks for line in block.lines]

    return renamed(wires + cells) + sorted(renamed(of_kind["connect"]))


def _in_order(top: str, children: dict[str, list[str]]) -> dict[str, None]:
    """Modules below `top` and itself, each before its cells' modules, in the order in which cells name them."""
    found: dict[str, None] = {}

    def enter(name: str) -> None:
        if name in children and name not in found:
            found[name] = None
            for child in children[name]:
                enter(child)

    enter(top)
    return found


def _renumbered(modules: dict[str, list[str]]) -> list[str]:
    """Modules in an order that does not depend on the names of those that Yosys derived from parameters, which become numbers."""
    children = {name: [line.split()[1] for line in lines if line.startswith("  cell ")] for name, lines in modules.items()}
    below = {child for some in children.values() for child in some}
    order = dict.fromkeys(module for top in sorted(modules.keys() - below) for module in _in_order(top, children))
    new_name = {name: f"$paramod${number:04d}\\{found.group(1)}" for number, name in enumerate(order) if (found := _DERIVED.match(name))}

    def renamed(line: str) -> str:
        if not line.startswith(("module ", "  cell ")):
            return line
        words = line.split(" ")
        return " ".join(new_name.get(word, word) for word in words)

    return [renamed(line) for name in order for line in modules[name]]


def canonical(text: str, root: Path) -> str:
    """The netlist (RTLIL) without traces of the source, which is below `root`."""
    lines = [line for line in text.replace(str(root), "").splitlines() if not _DROPPED.match(line)]
    modules: dict[str, list[str]] = {}
    head: list[str] = []
    gathered = head
    index = 0
    while index < len(lines):
        line = lines[index]
        if line.startswith("module "):
            end = lines.index("end", index)
            modules[line.split()[1]] = [*gathered, line, *_module(lines[index + 1:end]), "end"]
            gathered, index = [], end
        elif line.startswith("attribute ") and gathered is head:
            gathered = [line]
        else:
            gathered.append(line)
        index += 1
    return _RUNNING_NUMBER.sub("autoidx 1000000", "\n".join([*head, *_renumbered(modules)])) + "\n"
