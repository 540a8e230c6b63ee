# SPDX-License-Identifier: Apache-2.0
"""Writes many mutants into one SystemVerilog source. An environment variable makes one of them alive when a Verilated model starts."""

import re
from collections.abc import Mapping

from mutation.mutant import Mutant
from mutation.schemata import Schemata, written
from mutation.source import Source
from mutation.tokens import SYSTEMVERILOG

VARIABLE = "DTOF_LIVE_MUTANT"
PACKAGE = "dtof_live_mutant_pkg"
# A variable, not a parameter: Verilator cannot compute what depends on it.
DEFINITION = f'package {PACKAGE};\n  int LIVE = $c32("std::atoi(std::getenv(\\"{VARIABLE}\\"))");\nendpackage\n'
_COLON = re.compile(r"(?<!:):(?!:)")
_CONSTANTS = {"localparam", "parameter", "genvar", "typedef", "function"}  # statements that are computed before the simulation
_BODIES = {"#": "the parameters of an instance", "[": "a select or a width", "{": "a number of repetitions"}


def labels(mutant: Mutant) -> tuple[str, str] | None:
    """The two labels that a mutant with swapped arms exchanges; None if one is a list, or if the mutant is another one."""
    if mutant.operator != "swapped arms":
        return None
    first, second = (_COLON.split(text, maxsplit=1)[0] for text in (mutant.original, mutant.mutated))
    return None if "," in first + second else (first, second)


def constant(source: Source, mutant: Mutant) -> bool:
    """True if the mutant changes what is computed before the simulation starts. Verilator refuses those that this overlooks."""
    first = next(index for index, token in enumerate(source.tokens) if token.begin >= mutant.begin)
    if mutant.operator == "swapped arms":
        return labels(mutant) is None
    inside = [opening for opening, closing in source.partner.items() if opening < first < closing]
    for opening in inside:
        before = source.at(opening - 1)
        if source.at(opening) == "[" and (":" in _tokens(source, opening) or before in ("logic", ";", "]") or "+:" in _tokens(source, opening)):
            return True
        if source.at(opening) == "(" and (before == "#" or _named_parameter(source, opening)):
            return True
        if source.at(opening) == "(" and before == "for":
            return True
        if source.at(opening) == "{" and first == opening + 1 and source.at(first + 1) == "{":
            return True
    return _statement(source, first) in _CONSTANTS


def _tokens(source: Source, opening: int) -> list[str]:
    return [source.at(index) for index in range(opening, source.partner[opening])]


def _named_parameter(source: Source, opening: int) -> bool:
    """True in `.WIDTH(...)`: names of parameters are in upper case, those of ports in lower case."""
    return source.at(opening - 2) == "." and source.at(opening - 1).isupper()


def _statement(source: Source, index: int) -> str:
    """First word of the statement of a token."""
    while index > 0 and source.at(index - 1) not in (";", "begin", "end", "endgenerate", "generate", "endfunction"):
        index -= 1
    return source.at(index)


def apart(text: str, mutants: list[Mutant]) -> set[Mutant]:
    """Those that need a model of their own."""
    source = Source("", text, SYSTEMVERILOG)
    return {mutant for mutant in mutants if constant(source, mutant)}


def with_mutants(text: str, numbered: Mapping[Mutant, int]) -> Schemata:
    """Source with the mutants `numbered`, which do not overlap, with the numbers that activate them."""
    edits: dict[tuple[int, int], tuple[str, list[Mutant]]] = {}
    for mutant, number in numbered.items():
        both = labels(mutant)
        lives = f"{PACKAGE}::LIVE == {number}"
        if both is not None:
            first, second = both
            edits[mutant.begin, mutant.begin + len(first)] = (f"({lives} ? {second} : {first})", [mutant])
            edits[mutant.end - len(second), mutant.end] = (f"({lives} ? {first} : {second})", [mutant])
        elif mutant.original.endswith(";"):
            other = "" if mutant.mutated == ";" else f" else {mutant.mutated}"
            edits[mutant.begin, mutant.end] = (f"begin if (!({lives})) {mutant.original}{other} end", [mutant])
        else:
            edits[mutant.begin, mutant.end] = (f"({lives} ? ({mutant.mutated}) : ({mutant.original}))", [mutant])
    return written(text, edits, numbered)
