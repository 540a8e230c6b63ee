# SPDX-License-Identifier: Apache-2.0
"""Every mutant of a C++ source."""

import re
from collections.abc import Iterator
from dataclasses import replace

from mutation.mutant import Mutant
from mutation.operators import Builder, binary_changes, conditions, swapped_choice
from mutation.source import ASSIGNMENTS, Source
from mutation.tokens import CPP

# Names whose arguments are texts for the user or checked by the compiler.
_UNTOUCHED_CALLS = {"static_assert", "format", "decltype", "sizeof"}
_UNTOUCHED_STATEMENTS = {"using", "namespace", "template", "friend", "enum", "case", "default", "return", "throw", "if",
                         "for", "while", "else", "const", "constexpr", "static", "auto", "struct", "class", "public",
                         "private", "switch", "do", "try", "catch", "goto", "delete", "explicit", "virtual",
                         "operator"}  # fmt: skip
_OTHER_ASSIGNMENT = {"+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "|=": "&=", "&=": "|=", "<<=": ">>=", ">>=": "<<="}


def mutants(name: str, text: str) -> list[Mutant]:
    source = Source(name, text, CPP)
    build = Builder(source, _places(source))
    untouched = _untouched(source)
    constants = _constants(source)
    found: list[Mutant] = []
    for mutant in _all(build, untouched):
        if any(begin < mutant.end and mutant.begin < end for begin, end in untouched):
            continue
        constant = next((word for begin, end, word in constants if begin <= mutant.begin < end), None)
        found.append(replace(mutant, constant=constant))
    return found


def _all(build: Builder, untouched: list[tuple[int, int]]) -> Iterator[Mutant]:
    source = build.source
    for index, token in enumerate(source.tokens):
        if any(begin <= token.begin < end for begin, end in untouched):
            continue
        if token.kind == "number" and not _fixed(source, index):
            for step in ("+ 1", "- 1"):
                yield build.change("constant", index, index, f"{token.text} {step}")
        elif token.text in ("true", "false"):
            yield build.change("constant", index, index, "false" if token.text == "true" else "true")
        elif token.text in ("min", "max"):
            yield from _extremes(build, index)
        elif token.text == "?":
            yield from swapped_choice(build, index)
        elif token.kind == "operator" and source.is_binary(index):
            yield from binary_changes(build, index)
        elif (condition := conditions(build, index)) is not None:
            yield from _negated(build, *condition)
        if _begins_statement(source, index):
            yield from _changed_statement(build, index)


def _fixed(source: Source, index: int) -> bool:
    """True if a number is a template argument or marks a pure virtual function."""
    before, after = source.at(index - 1), source.at(index + 1)
    pure = before == "=" and after == ";" and source.at(index - 2) in (")", "const", "noexcept")
    argument = after in (">", ",") and before in ("<", ",") and not source.is_binary(index - 1)
    return pure or (argument and _in_template_arguments(source, index))


def _in_template_arguments(source: Source, index: int) -> bool:
    while index > 0 and source.at(index) not in (";", "{", "(", "}", ")"):
        index -= 1
        if source.at(index) == "<" and not source.is_binary(index):
            return True
    return False


def _negated(build: Builder, first: int, last: int) -> Iterator[Mutant]:
    text = build.source.span(first, last)
    if ";" not in text:
        yield build.change("condition", first, last, f"!({text})")


def _extremes(build: Builder, index: int) -> Iterator[Mutant]:
    """Calls of std::max instead of std::min, and the reverse."""
    source = build.source
    first = index - 2
    if source.at(first) == "ranges":
        first -= 2
    opening = index + 1
    if source.at(opening) == "<":
        while opening < len(source.tokens) and source.at(opening) != "(":
            opening += 1
    if source.at(first) != "std" or source.at(opening) != "(":
        return
    other = "max" if source.at(index) == "min" else "min"
    last = source.partner[opening]
    mutated = source.span(first, index - 1) + other + source.span(index + 1, last)
    yield build.change("min/max", first, last, mutated)


def _begins_statement(source: Source, index: int) -> bool:
    return source.at(index - 1) in (";", "{", "}")


def _changed_statement(build: Builder, first: int) -> Iterator[Mutant]:
    """Removes the effect of an expression statement, or changes its assignment operator."""
    source = build.source
    if source.at(first) in _UNTOUCHED_STATEMENTS:
        return
    last = first
    while last < len(source.tokens) and source.at(last) != ";":
        if source.at(last) in ("(", "[", "{"):
            last = source.partner.get(last, last)
        elif source.at(last) in ("}", ")"):
            return
        last += 1
    if source.at(last - 1) in ("default", "delete"):
        return
    if last >= len(source.tokens) or not _is_expression(source, first, last):
        return
    whole = source.span(first, last)
    yield build.change("removed statement", first, last, ";", statement=True)
    if source.at(first) in ("++", "--"):
        other = "--" if source.at(first) == "++" else "++"
        yield build.change("arithmetic", first, last, other + whole[2:], statement=True)
    for index in range(first, last):
        opposite = _OTHER_ASSIGNMENT.get(source.at(index))
        if opposite and source.partner.get(index) is None:
            mutated = f"{source.span(first, index - 1)} {opposite} {source.span(index + 1, last)}"
            yield build.change("arithmetic", first, last, mutated, statement=True)
            break


def _is_expression(source: Source, first: int, last: int) -> bool:
    """True for an assignment, call, increment, break or continue; false for a declaration. Only brackets may contain blanks."""
    if source.at(first) in ("break", "continue", "++", "--"):
        return True
    index = first
    while index < last and source.at(index) not in ASSIGNMENTS:
        following = source.partner[index] + 1 if source.at(index) in ("(", "[") else index + 1
        if following < last and source.at(following) not in ASSIGNMENTS:
            gap = source.text[source.tokens[following - 1].end : source.tokens[following].begin]
            if gap:
                return False
        index = following
    return source.at(index) in ASSIGNMENTS or source.at(last - 1) == ")"


def _places(source: Source) -> list[int]:
    """For each token, the index of the token at which its statement begins."""
    places = []
    begin = 0
    for index, token in enumerate(source.tokens):
        if _begins_statement(source, index):
            begin = token.begin
        places.append(begin)
    return places


def _untouched(source: Source) -> list[tuple[int, int]]:
    """Token ranges without mutants: arguments that are texts or types, enumerators and template parameters."""
    found = []
    for index, token in enumerate(source.tokens):
        if token.text in _UNTOUCHED_CALLS and source.at(index + 1) == "(":
            found.append((token.begin, source.tokens[source.partner[index + 1]].end))
        if token.text == "enum":
            opening = next(place for place in range(index, len(source.tokens)) if source.at(place) == "{")
            found.append((token.begin, source.tokens[source.partner[opening]].end))
    found += [match.span() for match in re.finditer(r"template <[^\n]*>$", source.text, re.MULTILINE)]
    return found


def _constants(source: Source) -> list[tuple[int, int, tuple[int, int]]]:
    """Begin and end of every constexpr variable, and the range of its `constexpr`."""
    found = []
    for index, token in enumerate(source.tokens):
        if token.text != "constexpr" or source.at(index - 1) in ("if", ")"):
            continue
        position = index + 1
        while position < len(source.tokens) and source.at(position) not in ("=", "(", ";", "{"):
            position += 1
        if source.at(position) != "=":
            continue
        while position < len(source.tokens) and source.at(position) != ";":
            position = source.partner.get(position, position) if source.at(position) in ("(", "{", "[") else position
            position += 1
        found.append((token.begin, source.tokens[position].end, (token.begin, token.end)))
    return found
