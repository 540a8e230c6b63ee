# SPDX-License-Identifier: Apache-2.0
"""A source file as tokens with brackets matched: where operands, calls and statements begin and end."""

from functools import cached_property

from mutation.tokens import CPP, Token, partners, tokenise

PRECEDENCE = {
    "**": 11, "*": 10, "/": 10, "%": 10, "+": 9, "-": 9, "<<": 8, ">>": 8, "<<<": 8, ">>>": 8,
    "<": 7, "<=": 7, ">": 7, ">=": 7, "==": 6, "!=": 6, "===": 6, "!==": 6, "&": 5, "^": 4, "|": 3, "&&": 2, "||": 1,
}  # fmt: skip
ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
_BOUNDARIES = {",", ";", "?", ":"} | ASSIGNMENTS
_KEYWORDS = {"return", "case", "else", "throw", "begin", "assign"}


class Source:
    def __init__(self, name: str, text: str, language: str) -> None:
        self.name = name
        self.text = text
        self.lines = text.splitlines()
        self.language = language
        self.tokens = tokenise(text, language)
        self.partner = partners(self.tokens)

    def line(self, position: int) -> int:
        return self.text.count("\n", 0, position) + 1

    def span(self, first: int, last: int) -> str:
        """Text from one token to another."""
        return self.text[self.tokens[first].begin : self.tokens[last].end]

    def at(self, index: int) -> str:
        return self.tokens[index].text if 0 <= index < len(self.tokens) else ""

    def is_binary(self, index: int) -> bool:
        token: Token = self.tokens[index]
        return (
            token.text in PRECEDENCE
            and self.text[token.begin - 1].isspace()
            and self.text[token.end].isspace()
            and index not in self._nonblocking
        )

    @cached_property
    def _nonblocking(self) -> set[int]:
        """Indices of `<=` that are SystemVerilog assignments: the first in a statement, outside brackets."""
        found: set[int] = set()
        if self.language == CPP:
            return found
        for index, token in enumerate(self.tokens):
            if token.text == "<=" and self._starts_assignment(index):
                found.add(index)
        return found

    def _starts_assignment(self, index: int) -> bool:
        """True if only the assignment's target stands between the statement's begin and `index`."""
        index -= 1
        while self.at(index) in ("]", "}"):
            if self.at(index) == "}":
                return self._begins_statement(self.partner[index])
            index = self.partner[index] - 1
        return index >= 0 and self.tokens[index].kind == "name" and self._begins_statement(index)

    def _begins_statement(self, index: int) -> bool:
        return self.at(index - 1) in (";", ")", ":", "begin", "else", "end")

    def left_operand(self, index: int) -> int:
        """First token of the left operand of a binary operator."""
        rank = PRECEDENCE[self.at(index)]
        start = position = index - 1
        while position >= 0:
            text = self.at(position)
            if text in (")", "]", "}"):
                position = self.partner.get(position, -1)
                if position < 0:
                    break
            elif text in ("(", "[", "{") or self._stops(position) or (
                self.is_binary(position) and PRECEDENCE[text] < rank
            ):
                break
            start = position
            position -= 1
        return start

    def right_operand(self, index: int) -> int:
        """Last token of the right operand of a binary operator."""
        rank = PRECEDENCE[self.at(index)]
        last = index
        position = index + 1
        while position < len(self.tokens):
            text = self.at(position)
            if text in ("(", "[") or (text == "{" and self._joined(position)):
                position = self.partner.get(position, len(self.tokens) - 1)
            elif text in (")", "]", "}", "{") or self._stops(position) or (
                self.is_binary(position) and PRECEDENCE[text] <= rank
            ):
                break
            last = position
            position += 1
        return last

    def _joined(self, index: int) -> bool:
        return self.language != CPP or self.tokens[index - 1].end == self.tokens[index].begin

    def _stops(self, index: int) -> bool:
        return self.at(index) in _BOUNDARIES or self.at(index) in _KEYWORDS or index in self._nonblocking

    def expression_begin(self, index: int) -> int:
        """First token of the condition of a `?` at `index`."""
        position = index - 1
        while position >= 0 and not self._stops(position) and self.at(position) not in ("(", "[", "{"):
            position = self.partner.get(position, position) if self.at(position) in (")", "]", "}") else position
            position -= 1
        return position + 1

    def expression_end(self, index: int) -> int:
        """Last token of the expression that begins at `index`; ends at any comma, colon or closing bracket."""
        position = index
        nested = 0
        while position < len(self.tokens):
            text = self.at(position)
            if text in ("(", "[", "{"):
                position = self.partner.get(position, position)
            elif text in (")", "]", "}", ",", ";") or (text == ":" and nested == 0):
                break
            elif text == "?":
                nested += 1
            elif text == ":":
                nested -= 1
            position += 1
        return position - 1
