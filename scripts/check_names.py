#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Everything that the RTL defines outside of modules has the prefix dtof_ (macros: DTOF_), so that a user's module, package, include file
or macro of the same name is impossible.

Looks at the files of hdl/dtof.f and at the include files in hdl/common. Prints a line for each name without the prefix.
"""

import re
import sys
from pathlib import Path

import rtl_text
from dtof_synth import program

ROOT = Path(__file__).resolve().parent.parent
PREFIX = "dtof_"
_DEFINED = re.compile(r"^\s*(?:module|package|interface|program|primitive|class|`define)\s+(?:automatic\s+|static\s+)?(\w+)", re.MULTILINE)
_SHARED_TYPE = re.compile(r"^typedef\b(?:[^;{]|\{[^}]*\})*?\b(\w+)\s*;", re.MULTILINE)  # in the first column: outside of modules


def names(text: str) -> list[tuple[int, str]]:
    """(line, name) of what a file defines for every other file. An include file's types belong to the module that includes the file."""
    code = rtl_text.without_comments(text)
    found = [*_DEFINED.finditer(code), *(_SHARED_TYPE.finditer(code) if "module" in code else ())]
    return sorted((code.count("\n", 0, one.start(1)) + 1, one.group(1)) for one in found)


def sources(root: Path) -> list[Path]:
    hdl = root / "hdl"
    lists = [hdl / name for name in ("dtof.f", "dtof_assertions.f") if (hdl / name).is_file()]
    listed = [line for name in lists for line in name.read_text(encoding="utf-8").splitlines() if line.endswith(".sv") and line[0] not in "/+"]
    return [*(hdl / line for line in listed), *sorted((hdl / "common").glob("*.svh"))]


def problems(root: Path) -> list[str]:
    found = []
    for path in sources(root):
        where = path.relative_to(root)
        if not path.name.startswith(PREFIX):
            found.append(f"{where}: the file's name lacks the prefix {PREFIX}")
        for line, name in names(path.read_text(encoding="utf-8")):
            if not name.lower().startswith(PREFIX):
                found.append(f"{where}:{line}: '{name}' lacks the prefix {PREFIX}")
    return found


def main() -> int:
    found = problems(ROOT)
    for line in found:
        print(f"error: {line}", file=sys.stderr)
    if not found:
        print(f"names: everything in {len(sources(ROOT))} files of RTL has the prefix {PREFIX}")
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
