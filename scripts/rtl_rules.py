# SPDX-License-Identifier: Apache-2.0
"""Rules of the RTL that strict front ends ask for and the project's own tools do not check. Each takes the texts of RTL files by their
names, and returns a line for each violation."""

import re

from rtl_text import blank, without_comments

_MODULE = re.compile(r"^module\s+(\w+)(.*?)\);\n(.*?)^endmodule", re.MULTILINE | re.DOTALL)
_BODY = re.compile(r"^(?:module|package|interface)\b.*?^end(?:module|package|interface)", re.MULTILINE | re.DOTALL)
_DIMENSION = r"(?:\[[^;=]*?\]\s*)?"
# A declaration in a module's body or in a generate block: its type, dimensions and names.
_DECLARED = re.compile(rf"^ +(?:logic|wire|reg|integer|int|genvar|\w+_t|`DTOF_TYPE\([^)]*\))\s+(?:signed\s+)?{_DIMENSION}{_DIMENSION}"
                       r"(\w+(?:\s*(?:\[[^\]]*\]\s*)?,\s*\w+)*)\s*(?:\[[^\]]*\]\s*)?(?:=[^;]*)?;", re.MULTILINE)  # fmt: skip
# Names of their own: subroutines, and macros, which stand where they are used.
_APART = re.compile(r"^ *(?:function|task)\b.*?^ *end(?:function|task)|^ *`define\b(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE | re.DOTALL)
# Names of these do not refer to a variable of the module: ports and parameters of an instance, fields, names of a package.
_ELSEWHERE = r"(?<![.\w:$`'])"


def _line(text: str, place: int) -> int:
    return text.count("\n", 0, place) + 1


def declared_before_use(sources: dict[str, str]) -> list[str]:
    """Uses of a name before its declaration. slang, VCS, Questa and Xcelium refuse them; Verilator, Yosys and Icarus Verilog accept
    them."""
    failures = []
    for name, text in sources.items():
        code = _APART.sub(blank, without_comments(text, strings=False))
        for module in _MODULE.finditer(code):
            first: dict[str, int] = {}
            for found in _DECLARED.finditer(code, module.start(3), module.end(3)):
                for variable in re.findall(r"(\w+)\s*(?:\[[^\]]*\]\s*)?(?:,|$)", found[1]):
                    first.setdefault(variable, found.start(1))
            for variable, place in first.items():
                used = re.compile(rf"{_ELSEWHERE}\b{variable}\b").search(code, module.start(3), place)
                if used is not None:
                    failures.append(f"{name}:{_line(code, used.start())}: '{variable}' is used in front of its declaration in line "
                                    f"{_line(code, place)}")  # fmt: skip
    return failures


def readable_headers(sources: dict[str, str]) -> list[str]:
    """A module's parameters and ports stand in its own file."""
    failures = []
    for name, text in sources.items():
        code = without_comments(text)
        for module in _MODULE.finditer(code):
            for found in re.finditer(r'`include\s+("[^"]*")', module[2]):
                failures.append(f"{name}:{_line(code, module.start(2) + found.start())}: the header of {module[1]} includes {found[1]}")
    return failures


def no_shared_types(sources: dict[str, str]) -> list[str]:
    """Uses of members of a type that is declared in no module and no package, at which Yosys 0.41 to 0.52 stop."""
    failures = []
    for name, text in sources.items():
        code = _BODY.sub(blank, without_comments(text, strings=False))
        failures += [f"{name}:{_line(code, found.start())}: a type outside of modules and packages"
                     for found in re.finditer(r"^\s*typedef\b", code, re.MULTILINE)]  # fmt: skip
    return failures


def check(sources: dict[str, str]) -> list[str]:
    return [*declared_before_use(sources), *readable_headers(sources), *no_shared_types(sources)]
