# SPDX-License-Identifier: Apache-2.0
"""Splits C++ and SystemVerilog into tokens, as far as mutants need it.

Both are formatted by a tool that puts blanks around binary operators and nowhere else, which tells `a < b` from
`vector<int>` and `a - b` from `-b` without a parser.
"""

import re
from dataclasses import dataclass

CPP = "C++"
SYSTEMVERILOG = "SystemVerilog"

_SKIPPED = r"(?P<skipped>//[^\n]*|/\*.*?\*/"
_PATTERNS = {
    CPP: re.compile(
        _SKIPPED + r"|^[ \t]*\#(?:[^\n\\]|\\.)*)"
        r'|(?P<text>R"\((?:.*?)\)"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\')'
        r"|(?P<number>(?:0[xX][0-9a-fA-F']+|\d[\d']*(?:\.\d*)?(?:[eE][+-]?\d+)?)[uUlLfFzZ]*)"
        r"|(?P<name>[A-Za-z_]\w*)"
        r"|(?P<operator><<=|>>=|<=>|\.\.\.|->|::|\+\+|--|&&|\|\||<<|>>|[-+*/%&|^<>=!]=|[^\s\w])",
        re.DOTALL | re.MULTILINE,
    ),
    SYSTEMVERILOG: re.compile(
        _SKIPPED + r"|`(?:include|define|ifdef|ifndef|else|endif|undef)\b[^\n]*)"
        r'|(?P<text>"(?:[^"\\\n]|\\.)*")'
        r"|(?P<number>\d*'[sS]?[bodhBODH][0-9a-fA-FxXzZ_?]+|'[01xz]|\d[\d_]*)"
        r"|(?P<name>[`$]?[A-Za-z_][\w$]*)"
        r"|(?P<operator><<<|>>>|===|!==|\+:|-:|\*\*|::|\+\+|--|&&|\|\||<<|>>|[-+*/%&|^<>=!~]=|~[&|^]|[^\s\w])",
        re.DOTALL | re.MULTILINE,
    ),
}


@dataclass(frozen=True)
class Token:
    kind: str  # text, number, name or operator
    text: str
    begin: int
    end: int


def tokenise(text: str, language: str) -> list[Token]:
    """Tokens of a source; comments and preprocessor lines are left out."""
    return [
        Token(match.lastgroup, match.group(), match.start(), match.end())
        for match in _PATTERNS[language].finditer(text)
        if match.lastgroup is not None and match.lastgroup != "skipped"  # every pattern has a name
    ]


def partners(tokens: list[Token]) -> dict[int, int]:
    """Index of the bracket that closes or opens each bracket."""
    closing = {"(": ")", "[": "]", "{": "}"}
    found: dict[int, int] = {}
    opened: list[int] = []
    for index, token in enumerate(tokens):
        if token.kind != "operator":
            continue
        if token.text in closing:
            opened.append(index)
        elif token.text in closing.values() and opened and closing[tokens[opened[-1]].text] == token.text:
            first = opened.pop()
            found[first] = index
            found[index] = first
    return found
