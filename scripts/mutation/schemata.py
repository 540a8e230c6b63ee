# SPDX-License-Identifier: Apache-2.0
"""Writes many mutants into one C++ source. At run time each place checks whether its mutant is active."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from mutation.mutant import Mutant


@dataclass(frozen=True)
class Schemata:
    """A source with mutants, and the lines of its text that belong to each mutant."""

    text: str
    lines: Mapping[Mutant, frozenset[int]]

    def mutants_at(self, line: int) -> set[Mutant]:
        return {mutant for mutant, lines in self.lines.items() if line in lines}


def with_mutants(text: str, numbered: Mapping[Mutant, int]) -> Schemata:
    """Source with the mutants `numbered`. They are mutants of `text` that do not overlap, with the numbers that activate them."""
    edits: dict[tuple[int, int], tuple[str, list[Mutant]]] = {}
    for mutant, number in numbered.items():
        edits[mutant.begin, mutant.end] = (_alternatives(mutant, number), [mutant])
        if mutant.constant is not None:
            # What changes at run time is no constant expression.
            inside = text[: mutant.constant[0]].rstrip().endswith("static")
            _, others = edits.setdefault(mutant.constant, ("inline const" if inside else "const", []))
            others.append(mutant)
    return written(text, edits, numbered)


def written(text: str, edits: Mapping[tuple[int, int], tuple[str, list[Mutant]]], mutants: Iterable[Mutant]) -> Schemata:
    """Applies edits, by the place that each replaces: its new text, and the mutants for which it is there."""
    parts: list[str] = []
    lines: dict[Mutant, set[int]] = {mutant: set() for mutant in mutants}
    line, position = 1, 0
    for (begin, end), (replacement, owners) in sorted(edits.items()):
        kept = text[position:begin]
        line += kept.count("\n")
        after = line + replacement.count("\n")
        for mutant in owners:
            lines[mutant].update(range(line, after + 1))
        parts += [kept, replacement]
        line, position = after, end
    parts.append(text[position:])
    return Schemata("".join(parts), {mutant: frozenset(found) for mutant, found in lines.items()})


def _alternatives(mutant: Mutant, number: int) -> str:
    lives = f"mutant_lives<{number}>()"
    if mutant.statement:
        return f"if ({lives}) {{ {mutant.mutated} }} else {{ {mutant.original} }}"
    return f"({lives} ? ({mutant.mutated}) : ({mutant.original}))"
