# SPDX-License-Identifier: Apache-2.0
"""A file without its comments, blank lines and the places of what it includes: what a digest is taken of. Neither a comment nor a
file that moves makes a report stale."""

import ast
import functools
import io
import re
import tokenize
from pathlib import PurePosixPath

C_LIKE = (".sv", ".svh", ".v", ".vlt", ".cpp", ".hpp", ".c", ".h", ".in")
HASH = (".tcl", ".sdc", ".toml", ".sh")
# Strings and character literals pass; a comment becomes a blank. 1'000 of C++ and 8'h0 of SystemVerilog have no closing mark.
C_TOKEN = re.compile(r'R"(?P<mark>[^\s()\\"]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.[^\']*|[^\'\\\n])\''
                     r"|(?P<comment>//[^\n]*|/\*.*?\*/)", re.DOTALL)
# The files that these lines name are inputs themselves.
OWN_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"[^"\n]*"', re.MULTILINE)
# These comments change what a tool does.
DIRECTIVE = re.compile(r"^(//|/\*)\s*(verilator|synopsys|synthesis|pragma|yosys)\b")


def c_like(text: str) -> str:
    def kept(match: re.Match[str]) -> str:
        comment = match["comment"]
        return match[0] if comment is None or DIRECTIVE.match(comment) else " "
    return C_TOKEN.sub(kept, OWN_INCLUDE.sub("", text))


def hash_comments(text: str) -> str:
    """Removes whole comment lines only: a # after code may be part of a string."""
    return "\n".join(line for line in text.splitlines() if not line.lstrip().startswith("#"))


def python(text: str) -> str:
    """Removes comments and docstrings."""
    lines = text.splitlines()
    try:
        tree = ast.parse(text)
        tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    except (SyntaxError, tokenize.TokenError):
        return text
    for token in tokens:
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column]
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and ast.get_docstring(node, False):
            docstring = node.body[0]
            for row in range(docstring.lineno - 1, docstring.end_lineno or docstring.lineno):
                lines[row] = ""
    return "\n".join(lines)


@functools.lru_cache(maxsize=4096)  # more than the project's files, and not every version of a history
def stripped(path: str, content: bytes) -> bytes:
    """The content of a file from which its digest is computed; `path` gives the language. Kept, because pages ask many times."""
    suffix = PurePosixPath(path).suffix
    work = c_like if suffix in C_LIKE else python if suffix == ".py" else hash_comments if suffix in HASH else None
    if work is None:
        return content
    text = work(content.decode("utf-8", errors="surrogateescape"))
    lines = (" ".join(line.split()) if work is c_like else line.rstrip() for line in text.splitlines())
    return "\n".join(line for line in lines if line).encode("utf-8", errors="surrogateescape")
