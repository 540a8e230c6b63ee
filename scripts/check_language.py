#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Comments, docstrings and pages have sentences that a stranger can read.

An error is: a comment, docstring or sentence that begins with "Of", whose noun the reader must guess; a thing "that there is", which should
say what exists; in comments of the RTL a verb of people (hear, know, want, forget, be told), and on a page "hear", for wires do none of
this; a name in C++, Python or JavaScript with such a verb (told, hears_...). docs/notes/ and CHANGELOG.md may say what they like.
"""

import re
import sys
from pathlib import Path

from dtof_synth import program
from figures.source_tree import SourceTree

ROOT = Path(__file__).resolve().parent.parent
SOURCES = (".sv", ".svh", ".py", ".cpp", ".hpp", ".c", ".h", ".js", ".sh", ".mk", ".tcl", ".toml", ".cmake", ".in")
PAGES = (".md", ".mustache")
NO_NOUN = re.compile(r"(?:^|\s)(?://+|#+|\"\"\"|\*)\s*Of\s+[a-zA-Z]")
NO_NOUN_ON_A_PAGE = re.compile(r"(?:^|[.:|]\s+)Of [a-z]")
NOT_THERE = re.compile(r"\b(?:field|file|limit|name|one|row|those) that there (?:is|are)\b")
PERSON = re.compile(r"//.*\b(hears?|heard|knows?|knew|wants?|wanted|forgets?|told)\b")
PERSON_IN_A_NAME = re.compile(r"\b((?:hears|heard|told|knows)_\w+|told)\b(?=\s*[;=.\[({])")
CODE = (".py", ".cpp", ".hpp", ".js")
PERSON_ON_A_PAGE = re.compile(r"\b(hears?|heard)\b")


def problem(name: str, line: str) -> str:
    """Fault of this line of a file; empty if there is none."""
    if NOT_THERE.search(line):
        return "'that there is': say what exists or does not"
    if name.endswith(PAGES):
        if NO_NOUN_ON_A_PAGE.search(line):
            return "a sentence begins with 'Of': say what it is about"
        found = PERSON_ON_A_PAGE.search(line)
        return f"'{found[1]}' on a page: wires do not" if found else ""
    if NO_NOUN.search(line):
        return "a comment begins with 'Of': say what it describes"
    found = PERSON_IN_A_NAME.search(line) if name.endswith(CODE) and not name.startswith(("synth/", "scripts/tests/test_check_language.py")) else None
    if found:
        return f"the name '{found[1]}': functions and objects do not"
    found = PERSON.search(line) if name.startswith(("hdl/", "formal/", "fpga/", "examples/")) and name.endswith((".sv", ".svh")) else None
    return f"'{found[1]}' in the RTL: wires do not" if found else ""


def files(root: Path) -> list[str]:
    return [name for name in sorted(SourceTree(root).files) if (
        name.endswith(SOURCES) or (name.endswith(PAGES) and not name.startswith(("reports/", "docs/notes/", "CHANGELOG"))))]


def problems(root: Path) -> list[str]:
    found = []
    for name in files(root):
        for number, line in enumerate((root / name).read_text(encoding="utf-8").splitlines(), 1):
            sentence = problem(name, line)
            if sentence:
                found.append(f"{name}:{number}: {sentence}")
    return found


def main() -> int:
    found = problems(ROOT)
    for line in found:
        print(f"error: {line}", file=sys.stderr)
    if not found:
        print(f"language: {len(files(ROOT))} files, no comment without a noun, no wire that hears")
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
