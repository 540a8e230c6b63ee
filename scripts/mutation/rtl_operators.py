# SPDX-License-Identifier: Apache-2.0
"""Mutants of a SystemVerilog source. They change module bodies, but no widths, assertions or parameter ranges."""

import re
from collections.abc import Iterator

from mutation.mutant import Mutant
from mutation.operators import Builder, binary_changes, conditions, swapped_choice
from mutation.source import Source
from mutation.tokens import SYSTEMVERILOG

_STATEMENT_ENDS = {";", "begin", "end", "else", "generate", "endgenerate", "endcase"}
_DECLARATIONS = {"logic", "input", "output", "reg", "wire", "genvar", "integer", "function", "typedef"}
_LABEL = re.compile(r"^ *([\w:']+):(?=\s)", re.MULTILINE)


def mutants(name: str, text: str) -> list[Mutant]:
    source = Source(name, text, SYSTEMVERILOG)
    build = Builder(source, _places(source))
    untouched = _untouched(source)
    return [
        mutant
        for mutant in _all(build)
        if not any(begin < mutant.end and mutant.begin < end for begin, end in untouched)
    ]


def _all(build: Builder) -> Iterator[Mutant]:
    source = build.source
    for index, token in enumerate(source.tokens):
        if token.kind == "number":
            for other in _other_numbers(token.text):
                yield build.change("constant", index, index, other)
        elif token.text == "?":
            yield from swapped_choice(build, index)
        elif token.text == "<=" and not source.is_binary(index):
            yield from _dropped(build, index)
        elif token.kind == "operator" and source.is_binary(index):
            yield from binary_changes(build, index)
        elif token.text == "assign":
            yield from _constant_strobe(build, index)
        elif token.text == "case":
            yield from _swapped_arms(build, index)
        elif (condition := conditions(build, index)) is not None:
            yield from _other_conditions(build, *condition)


def _other_numbers(text: str) -> list[str]:
    if text.isdigit():
        return [f"({text} + 1)", f"({text} - 1)"]
    if text in ("'0", "'1"):
        return ["'1" if text == "'0" else "'0"]
    sized = re.fullmatch(r"(\d+)'([bodh])([0-9a-fA-F_]+)", text)
    if sized is None:
        return []
    width = int(sized.group(1))
    base = {"b": 2, "o": 8, "d": 10, "h": 16}[sized.group(2)]
    value = int(sized.group(3).replace("_", ""), base)
    return sorted({f"{width}'d{(value + step) % (1 << width)}" for step in (1, -1)})


def _other_conditions(build: Builder, first: int, last: int) -> Iterator[Mutant]:
    yield build.change("condition", first, last, f"!({build.source.span(first, last)})")
    for constant in ("1'b0", "1'b1"):
        yield build.change("constant strobe", first, last, constant)


def _dropped(build: Builder, index: int) -> Iterator[Mutant]:
    """Removes the effect of a nonblocking assignment."""
    source = build.source
    first = index - 1
    while first > 0 and source.at(first - 1) not in _STATEMENT_ENDS | {")", ":"}:
        first = source.partner.get(first, first) if source.at(first) in ("]", "}") else first
        if source.at(first - 1) in _STATEMENT_ENDS | {")", ":"}:
            break
        first -= 1
    last = index
    while source.at(last) != ";":
        last += 1
    yield build.change("dropped assignment", first, last, ";")


def _constant_strobe(build: Builder, index: int) -> Iterator[Mutant]:
    """Makes a signal that is a logical expression constant."""
    source = build.source
    equals = index
    while source.at(equals) != "=":
        equals += 1
    last = equals
    while source.at(last + 1) != ";":
        last += 1
    outside = [source.at(position) for position in range(equals + 1, last + 1)]
    if {"&&", "||", "==", "!=", "!"} & set(outside) and "?" not in outside and "{" not in outside:
        for constant in ("1'b0", "1'b1"):
            yield build.change("constant strobe", equals + 1, last, constant)


def _swapped_arms(build: Builder, index: int) -> Iterator[Mutant]:
    """Exchanges two neighbouring arms of a case."""
    source = build.source
    end = index
    while source.at(end) != "endcase":
        end += 1
    body = source.text[source.tokens[index].begin : source.tokens[end].begin]
    begins = [source.tokens[index].begin + match.start(1) for match in _LABEL.finditer(body) if match[1] != "default"]
    starts = {token.begin: position for position, token in enumerate(source.tokens)}
    labels = [starts[begin] for begin in begins if begin in starts]
    for first, second in zip(labels, labels[1:]):
        one, other = (_label_end(source, label) for label in (first, second))
        between = source.text[source.tokens[one].end : source.tokens[second].begin]
        mutated = source.span(second, other) + between + source.span(first, one)
        yield build.change("swapped arms", first, other, mutated)


def _label_end(source: Source, index: int) -> int:
    while source.at(index + 1) != ":":
        index += 1
    return index


def _places(source: Source) -> list[int]:
    places = []
    begin = 0
    for index, token in enumerate(source.tokens):
        if source.at(index - 1) in _STATEMENT_ENDS:
            begin = token.begin
        places.append(begin)
    return places


def _untouched(source: Source) -> list[tuple[int, int]]:
    """Token ranges without mutants: module headers, ranges in declarations, checks, conditions of generate blocks, unused signals."""
    tokens = source.tokens
    found = []
    header = None
    for index, token in enumerate(tokens):
        if token.text == "module":
            header = token.begin
        elif token.text == ";" and header is not None:
            found.append((header, token.end))
            header = None
        elif token.text.startswith("`DTOF_") or token.text.startswith("$"):
            if source.at(index + 1) == "(" and token.text not in ("$signed", "$unsigned", "$clog2", "$countones"):
                found.append((token.begin, tokens[source.partner[index + 1]].end))
        elif token.text == "[" and _in_declaration(source, index):
            found.append((token.begin, tokens[source.partner[index]].end))
        elif token.text in ("if", "for") and source.at(index + 1) == "(":
            closing = source.partner[index + 1]
            if source.at(closing + 1) == "begin" and source.at(closing + 2) == ":":
                found.append((token.begin, tokens[closing].end))
        elif token.text == "assign" and source.at(index + 1).startswith("unused"):
            last = index
            while source.at(last) != ";":
                last += 1
            found.append((token.begin, tokens[last].end))
    return found


def _in_declaration(source: Source, index: int) -> bool:
    """True if a range follows the type or the name in a declaration."""
    position = index - 1
    while position >= 0 and source.at(position) not in _STATEMENT_ENDS | {"(", "="}:
        if source.at(position) in _DECLARATIONS or source.at(position) in ("localparam", "parameter"):
            return True
        position = source.partner.get(position, position) if source.at(position) in ("]", "}", ")") else position
        position -= 1
    return False
