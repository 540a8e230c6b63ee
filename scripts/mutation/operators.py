# SPDX-License-Identifier: Apache-2.0
"""Changes common to C++ and SystemVerilog: operators, constants, conditions."""

from collections.abc import Iterator

from mutation.mutant import Mutant
from mutation.source import Source

Others = dict[str, tuple[str, ...]]  # by operator, what takes its place

RELATIONAL: Others = {
    "<": ("<=", ">="),
    "<=": ("<", ">"),
    ">": (">=", "<="),
    ">=": (">", "<"),
    "==": ("!=",),
    "!=": ("==",),
}
ARITHMETIC: Others = {"+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "%": ("/",)}
BITWISE: Others = {"&": ("|",), "|": ("&",), "^": ("|",)}
LOGICAL: Others = {"&&": ("||",), "||": ("&&",)}
SHIFTS = {"<<", ">>", ">>>", "<<<"}
BINARY = {"relational": RELATIONAL, "arithmetic": ARITHMETIC, "bitwise": BITWISE, "logical": LOGICAL}


class Builder:
    """Makes the mutants of one source, each with its statement."""

    def __init__(self, source: Source, places: list[int]) -> None:
        self.source = source
        self._places = places  # of each token

    def change(self, operator: str, first: int, last: int, mutated: str, statement: bool = False) -> Mutant:
        """A mutant that replaces the tokens first to last."""
        tokens = self.source.tokens
        begin = tokens[first].begin
        line = self.source.line(begin)
        lines = self.source.lines
        return Mutant(
            file=self.source.name,
            line=line,
            begin=begin,
            end=tokens[last].end,
            original=self.source.span(first, last),
            mutated=mutated,
            operator=operator,
            source=lines[line - 1].strip(),
            above=lines[line - 2].strip() if line > 1 else "",
            place=self._places[first],
            statement=statement,
        )


def binary_changes(build: Builder, index: int) -> Iterator[Mutant]:
    """Other operators in place of the binary operator at `index`; shifts by one more and one less."""
    source = build.source
    text = source.at(index)
    first, last = source.left_operand(index), source.right_operand(index)
    if first >= index or last <= index:
        return
    left, right = source.span(first, index - 1), source.span(index + 1, last)
    for operator, table in BINARY.items():
        for other in table.get(text, ()):
            yield build.change(operator, first, last, f"{left} {other} {right}")
    if text in SHIFTS:
        for step in ("+ 1", "- 1"):
            yield build.change("shift", first, last, f"{left} {text} (({right}) {step})")


def swapped_choice(build: Builder, index: int) -> Iterator[Mutant]:
    """`c ? a : b` at the index of its question mark becomes `c ? b : a`."""
    source = build.source
    first = source.expression_begin(index)
    colon = source.expression_end(index + 1) + 1
    if source.at(colon) != ":" or first >= index:
        return
    last = source.expression_end(colon + 1)
    condition, yes = source.span(first, index - 1), source.span(index + 1, colon - 1)
    no = source.span(colon + 1, last)
    yield build.change("choice", first, last, f"{condition} ? ({no}) : ({yes})")


def conditions(build: Builder, index: int) -> tuple[int, int] | None:
    """First and last token of the condition of an `if` or `while` at `index`."""
    opening = index + 1
    if build.source.at(index) not in ("if", "while") or build.source.at(opening) != "(":
        return None
    return opening + 1, build.source.partner[opening] - 1
