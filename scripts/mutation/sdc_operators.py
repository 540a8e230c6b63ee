# SPDX-License-Identifier: Apache-2.0
"""Mutants of timing constraints (SDC): removed commands, other figures, the other of two options or of two kinds of ports."""

import re
from collections.abc import Iterator

from mutation.mutant import Mutant

PAIRS = (("-setup", "-hold"), ("-late", "-early"), ("-from", "-to"), ("all_inputs", "all_outputs"), ("set_input_delay", "set_output_delay"))
OTHER_WORDS = {word: other for pair in PAIRS for word, other in (pair, pair[::-1])}
FIGURE = re.compile(r"(?<![\w$.])\d+(?:\.\d+)?(?![\w.])")
WORD = re.compile(r"(?<![\w$])(?:" + "|".join(OTHER_WORDS) + r")(?!\w)")
COMMAND = re.compile(r"^ *((?:set_\w+|create_clock) [^\n]*)$|\{ (set_\w+ [^\n]*) \}$", re.MULTILINE)
COMMENT = re.compile(r"^#[^\n]*$", re.MULTILINE)


def _found(text: str) -> Iterator[tuple[str, int, int, str]]:
    """(operator, begin, end, mutated)"""
    for match in FIGURE.finditer(text):
        for factor in ("1.1", "0.5"):
            yield "constant", match.start(), match.end(), f"{float(match.group()) * float(factor):g}"
    for match in WORD.finditer(text):
        yield "name", match.start(), match.end(), OTHER_WORDS[match.group()]
    for match in COMMAND.finditer(text):
        group = 1 if match.group(1) else 2
        yield "statement", match.start(group), match.end(group), "list"  # a command that does nothing


def mutants(file: str, text: str) -> list[Mutant]:
    lines = text.splitlines()
    comments = [match.span() for match in COMMENT.finditer(text)]
    found = []
    for operator, begin, end, mutated in _found(text):
        if any(first <= begin < last for first, last in comments):
            continue
        line = text.count("\n", 0, begin) + 1
        found.append(
            Mutant(
                file=file,
                line=line,
                begin=begin,
                end=end,
                original=text[begin:end],
                mutated=mutated,
                operator=operator,
                source=lines[line - 1].strip(),
                above=lines[line - 2].strip() if line > 1 else "",
                place=text.rfind("\n", 0, begin) + 1,
                statement=operator == "statement",
            )
        )
    return found
