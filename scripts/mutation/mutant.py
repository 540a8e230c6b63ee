# SPDX-License-Identifier: Apache-2.0
"""Mutants, and how they are drawn."""

import random
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    """One change of one source file: text[begin:end] becomes `mutated`."""

    file: str  # path below the project
    line: int
    begin: int
    end: int
    original: str
    mutated: str
    operator: str
    source: str  # the line of the source on which it begins, without blanks at its ends
    above: str  # the line above it
    place: int  # where its statement begins: one mutant per statement is drawn
    statement: bool = False  # the whole statement changes, not an expression
    constant: tuple[int, int] | None = None  # C++: the `constexpr` of the variable whose value changes

    @property
    def change(self) -> str:
        return f"{one_line(self.original)} -> {one_line(self.mutated)}"

    def planted(self, text: str) -> str:
        """The source with the mutant."""
        return text[: self.begin] + self.mutated + text[self.end :]

    def overlaps(self, other: "Mutant") -> bool:
        return self.file == other.file and self.begin < other.end and other.begin < self.end


def one_line(text: str) -> str:
    return " ".join(text.split()) or "(removed)"


def draw(mutants: Iterable[Mutant], seed: int) -> Iterator[Mutant]:
    """Draws one mutant per statement, in random order: first the kind of change, then the change.

    A statement's position and mutant depend on the seed and its own text alone, so changes of other code draw no new mutants.
    """
    places: dict[tuple[str, int], list[Mutant]] = {}
    for mutant in mutants:
        places.setdefault((mutant.file, mutant.place), []).append(mutant)
    seen: Counter[str] = Counter()
    ranked: list[tuple[float, Mutant]] = []
    for (file, _), choices in places.items():
        text = f"{file} {[mutant.change for mutant in choices]}"
        seen[text] += 1
        generator = random.Random(f"{seed} {seen[text]} {text}")
        rank = generator.random()
        operator = generator.choice(sorted({mutant.operator for mutant in choices}))
        ranked.append((rank, generator.choice([mutant for mutant in choices if mutant.operator == operator])))
    for _, mutant in sorted(ranked, key=lambda item: (item[0], item[1].file, item[1].begin)):
        yield mutant


class Selection:
    """Mutants from several groups of files: a given number from each, or all. Rejected ones are replaced by the next drawn."""

    def __init__(self, groups: Sequence[tuple[Iterable[Mutant], int]], seed: int, always: Iterable[Mutant] = ()) -> None:
        self._always = list(always)
        self._queues = [draw(mutants, seed) for mutants, _ in groups]
        self._wanted = [count for _, count in groups]
        self._kept: list[list[Mutant]] = [[] for _ in groups]
        self.fill()

    def fill(self) -> None:
        for kept, queue, wanted in zip(self._kept, self._queues, self._wanted):
            while len(kept) < wanted:
                mutant = next(queue, None)
                if mutant is None:
                    break
                if not any(mutant.overlaps(other) for other in [*kept, *self._always]):
                    kept.append(mutant)

    def refuse(self, refused: set[Mutant]) -> None:
        """Replaces mutants that do not compile."""
        self._always = [mutant for mutant in self._always if mutant not in refused]
        self._kept = [[mutant for mutant in kept if mutant not in refused] for kept in self._kept]
        self.fill()

    @property
    def mutants(self) -> list[Mutant]:
        chosen = [*self._always, *(mutant for kept in self._kept for mutant in kept)]
        return sorted(chosen, key=lambda mutant: (mutant.file, mutant.begin))
