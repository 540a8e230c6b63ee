# SPDX-License-Identifier: Apache-2.0
"""Rules of the RTL that strict front ends ask for and the project's own tools do not check. Each takes the texts of RTL files by their
names, and returns a line for each violation."""

import re

from rtl_text import blank, without_comments

_MODULE = re.compile(r"^module\s+(\w+)(.*?)\);\n(.*?)^endmodule", re.MULTILINE | re.DOTALL)
_BODY = re.compile(r"^(?:module|package|interface)\b.*?^end(?:module|package|interface)", re.MULTILINE | re.DOTALL)
_DIMENSION = r"(?:\[[^;=]*?\]\s*)?"
# A declaration in a module's body or in a generate block: its type, dimensions and names.
_TYPE = r"(?:logic|bit|byte|wire|reg|integer|int|genvar|(?:\w+::)?\w+_t|`DTOF_TYPE\([^)]*\))"
_DECLARED = re.compile(rf"^ +(?:localparam(?:\s+{_TYPE})?|{_TYPE})\s+(?:(?:un)?signed\s+)?{_DIMENSION}{_DIMENSION}"
                       r"(\w+(?:\s*(?:\[[^\]]*\]\s*)?,\s*\w+)*)\s*(?:\[[^\]]*\]\s*)?(?:=[^;]*)?;", re.MULTILINE)  # fmt: skip
_TYPE_DECLARED = re.compile(r"^ +typedef\b(?:[^;{]|\{[^}]*\})*?\b(\w+)\s*;", re.MULTILINE)
# Names of their own: subroutines, and macros, which stand where they are used.
_APART = re.compile(r"^ *(?:function|task)\b.*?^ *end(?:function|task)|^ *`define\b(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE | re.DOTALL)
# Names of these do not refer to a variable of the module: ports and parameters of an instance, fields, names of a package.
_ELSEWHERE = r"(?<![.\w:$`'])"

_MOST_PARTS = 16  # of a concatenation
# What stands outside of a module or a package and declares something for other files.
_SHARED = re.compile(r"^[ \t]*(?:(typedef)\b(?:[^;{]|\{[^}]*\})*;|(function|task)\b.*?^[ \t]*end\2|"
                     r"(import|localparam|parameter|let|logic|wire|int|bit|enum|struct)\b)", re.MULTILINE | re.DOTALL)  # fmt: skip
_KINDS = {"typedef": "type", "import": "import", "function": "function", "task": "task"}  # others: declaration
_APART_MACROS = re.compile(r"^ *`define\b(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
_DIRECTIVES = {"begin_keywords", "celldefine", "default_nettype", "define", "else", "elsif", "end_keywords", "endcelldefine", "endif", "ifdef", "ifndef",
               "include", "line", "nounconnected_drive", "pragma", "resetall", "timescale", "unconnected_drive", "undef", "undefineall",
               "__FILE__", "__LINE__"}  # fmt: skip


def _reached(code: str, included: dict[str, str]) -> list[str]:
    """Names of the files that a text includes, and that those include. `code` has no comments."""
    found: list[str] = []
    waiting = [code]
    while waiting:
        for file in re.findall(r'`include\s+"([^"]*)"', waiting.pop()):
            if file in included and file not in found:
                found.append(file)
                waiting.append(without_comments(included[file]))
    return found


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
            for found in (*_DECLARED.finditer(code, module.start(3), module.end(3)), *_TYPE_DECLARED.finditer(code, module.start(3), module.end(3))):
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


def no_shared_types(sources: dict[str, str], included: dict[str, str]) -> list[str]:
    """Declarations outside of modules and packages, also in files that are included there. At members of such types Yosys 0.41 to 0.52 stop,
    and a tool that compiles each file alone knows none of them in another file."""
    failures = []
    for name, text in sources.items():
        outside = _BODY.sub(blank, without_comments(text))
        for file, code in [(name, outside), *((file, without_comments(included[file])) for file in _reached(outside, included))]:
            failures += [f"{file}:{_line(code, found.start(found.lastindex or 0))}: a {_KINDS.get(found[found.lastindex or 0], 'declaration')} "
                         "outside of modules and packages"
                         for found in _SHARED.finditer(_APART_MACROS.sub(blank, code))]  # fmt: skip
    return list(dict.fromkeys(failures))


def known_macros(sources: dict[str, str], included: dict[str, str]) -> list[str]:
    """Uses of a macro that neither the file nor a file that it includes defines: they depend on the order of files, and fail where a tool
    compiles each file alone. A macro that the file asks for by `ifdef may come from the command line."""
    failures = []
    for name, text in sources.items():
        code = without_comments(text, strings=False)
        texts = [code, *(without_comments(included[file]) for file in _reached(without_comments(text), included))]
        known = set(re.findall(r"`(?:ifdef|ifndef|elsif)\s+(\w+)", code))
        known.update(macro for one in texts for macro in re.findall(r"`define\s+(\w+)", one))
        for found in re.finditer(r"`(\w+)", code):
            if found[1] not in _DIRECTIVES | known:
                failures.append(f"{name}:{_line(code, found.start())}: neither this file nor one that it includes defines `{found[1]}")
    return failures


def short_concatenations(sources: dict[str, str]) -> list[str]:
    """Many signals that travel together are a struct, and no concatenation; what has no use may be one: unused = ^{...}."""
    failures = []
    for name, text in sources.items():
        code = without_comments(text, strings=False)
        for found in re.finditer(r"(?<!\^)\{([^{};]*)\}", code):
            parts = found[1].count(",") + 1
            if parts > _MOST_PARTS:
                failures.append(f"{name}:{_line(code, found.start())}: a concatenation of {parts} names, where {_MOST_PARTS} are the most: use a struct")
    return failures


def check(sources: dict[str, str], included: dict[str, str]) -> list[str]:
    """`included`: texts of the include files, by their names without folder."""
    return [*declared_before_use(sources), *readable_headers(sources), *no_shared_types(sources, included),
            *known_macros(sources, included), *short_concatenations(sources)]
