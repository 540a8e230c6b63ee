# SPDX-License-Identifier: Apache-2.0
"""Figures that somebody typed: mm2, um2, mW, MHz or per cent beside a read-out's name, on a page that is no dated note, outside of
references and of blocks that a script writes. Beside: in one sentence, table row or section of that name. A page of the blocks is
about read-outs as a whole. The numbers of a table have the unit of its column, or of the paragraph in front of it."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from . import references
from .source_tree import SourceTree

NOTES = "docs/notes/"
NUMBER = r"[+-]?\d[\d,]*(?:\.\d+)?"
UNIT = r"(?:mm2|mm\^2|um2|mW|MHz|%|per cent)"
# 0.58 instead of 1.29 mm2: the first number has the unit, too.
FIGURE = re.compile(rf"(?<![\w.,]){NUMBER}(?:\s*(?:\+-|/|,|and|or|to|instead of|,? and)\s*{NUMBER})*\s?{UNIT}(?!\w)")
UNIT_OF_A_COLUMN = re.compile(rf"(?<![\w]){UNIT}(?!\w)")
# What a figure is measured by: limits of errors, the level of intervals, the clock that is asked for, a node's name.
BY_DEFINITION = re.compile(
    r"(?:above|more than|beyond|below|at most|at least|within|>|limit) (?:3|10) ?(?:%|per cent)"
    r"(?:(?: and | or |, | ?/ ?)(?:above )?10 ?(?:%|per cent))?|95 ?(?:%|per cent)|(?:330|500) MHz")
# The name of a word that has other meanings, too, is no sign of a read-out.
COMMON_WORDS = {"histogram"}
OF_READOUTS = "docs/reference/blocks/"
# "in mm2 unless said otherwise", "Per cent of the pixels": what a table below such words has.
IN_A_UNIT = re.compile(r"\bin (?:mm2|um2|mW|MHz|per cent)\b|\b(?:[Pp]er cent|mm2|um2|mW|MHz) of\b")
BLOCK = re.compile(r"<!-- (?P<name>[^>]*?): written by [^>]*-->.*?<!-- end of [^>]*-->", re.DOTALL)
CODE = re.compile(r"^(```|~~~).*?^\1[ \t]*$", re.DOTALL | re.MULTILINE)
INDENTED = re.compile(r"(?:(?<=\n\n)|\A)(?: {4}.*\n)+", re.MULTILINE)
QUIET = (re.compile(r"<!--.*?-->", re.DOTALL), re.compile(r"`[^`\n]+`"), re.compile(r"\]\([^)\s]*\)"))
HEADING = re.compile(r"^(#+) +(.*)$")
SENTENCE_END = re.compile(r"(?<=[.!?])\s+(?=\D)")  # no end: Fig. 3


@dataclass(frozen=True)
class Piece:
    """A sentence or table row, the first of its lines, and the headings that it stands below."""

    line: int
    text: str
    subject: str
    figures: tuple[str, ...] = ()


def titles(root: Path) -> re.Pattern[str]:
    """A pattern of the read-outs' titles, as pages write them."""
    described = tomllib.loads((root / "readouts.toml").read_text(encoding="utf-8"))["readout"]
    names = {entry["title"] for entry in (described.values() if isinstance(described, dict) else described)} - COMMON_WORDS
    names |= {name.replace(" v1", "") for name in names} | {"lean", "Lean", "full histogram"}
    return re.compile(r"(?<!\w)(?:" + "|".join(map(re.escape, sorted(names, key=len, reverse=True))) + r")(?!\w)")


def _blank(match: re.Match[str]) -> str:
    """Removes the match, but keeps its number of lines."""
    return "\n" * match[0].count("\n")


def quiet(text: str) -> str:
    """The page without references, code, generated blocks and addresses; line numbers stay."""
    for pattern in (BLOCK, CODE, INDENTED):
        text = pattern.sub(_blank, text)
    text = references.REFERENCE.sub(lambda match: "REFERENCE" + _blank(match), text)
    for pattern in QUIET:
        text = pattern.sub(_blank, text)
    return text


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def pieces(text: str) -> Iterator[Piece]:
    path: list[str] = []
    header: list[str] | None = None
    paragraph: list[tuple[int, str]] = []
    before = ""  # the paragraph in front of a table

    def sentences() -> Iterator[Piece]:
        joined, starts = "", []
        for number, line in paragraph:
            starts.append((len(joined), number))
            joined += line.strip() + " "
        paragraph.clear()
        nonlocal before
        before = joined
        begin = 0
        for part in SENTENCE_END.split(joined):
            begin = joined.index(part, begin)
            number = max(number for start, number in starts if start <= begin)
            yield Piece(number, part, " / ".join(path), tuple(FIGURE.findall(BY_DEFINITION.sub(" ", part))))
            begin += len(part)

    for number, line in enumerate(text.splitlines(), 1):
        heading = HEADING.match(line)
        row = line.startswith("|")
        if paragraph and (heading or row or not line.strip() or re.match(r"\s*([*-]|\d+\.) ", line)):
            yield from sentences()
        if not row:
            header = None
        if heading:
            before = ""
            level = len(heading[1])
            path = [*path[:level - 1], *[""] * (level - 1 - len(path)), heading[2]]
        elif row:
            cells = _cells(line)
            if header is None:
                header = cells
            elif not all(re.fullmatch(r":?-+:?", cell) for cell in cells):
                found = list(FIGURE.findall(BY_DEFINITION.sub(" ", line)))
                unit = IN_A_UNIT.search(before)
                for name, cell in list(zip(header, cells))[1:]:
                    if (unit or UNIT_OF_A_COLUMN.search(name)) and re.match(NUMBER + r"(?!\w)", cell):
                        found.append(f"{cell} ({name})")
                yield Piece(number, line, " / ".join([*path, *header[:1]]), tuple(found))
        elif line.strip():
            paragraph.append((number, line))
    if paragraph:
        yield from sentences()


def in_page(text: str, names: re.Pattern[str], of_readouts: bool = False) -> list[Piece]:
    """Pieces of a page that have a figure beside a read-out's name. With `of_readouts`, every figure of the page counts."""
    return [replace(piece, text=piece.text.strip()) for piece in pieces(quiet(text))
            if piece.figures and (of_readouts or names.search(piece.text) or names.search(piece.subject))]


def check(root: Path, tree: SourceTree) -> list[str]:
    names = titles(root)
    return [f"{page}:{piece.line}: the figure {piece.figures[0]} is typed by hand beside a read-out's name: refer to it "
            "(docs/reference/figures.md)"
            for page in references.pages(tree) if not page.startswith(NOTES) for piece in in_page(tree.text(page), names, page.startswith(OF_READOUTS))]
