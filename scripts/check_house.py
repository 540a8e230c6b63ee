#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The house's rules: which library may include which, and what may only become less.

Arrows: a C++ library includes headers of the libraries that its CMakeLists.txt names (DEPENDS, PRIVATE_DEPENDS, and what those depend on);
no library depends on itself by way of others; models/ depends on no other room.
Ratchets (scripts/house.toml): how many files are longer than 500 lines, how many functions longer than 80, in how many files outside of
hdl/ and models/ a parameter's name is typed by hand, how many statements change sys.path (docs/reference/decisions.md says how Python finds
modules instead). More than the number is an error, and so is less: lower the number then.
"""

import ast
import re
import sys
import tomllib
from pathlib import Path

from dtof_synth import program
from figures.source_tree import SourceTree

ROOT = Path(__file__).resolve().parent.parent
LIMITS = "scripts/house.toml"
ROOMS = ("models", "tb_cpp", "app", "studies", "python", "tests")
LIBRARY = re.compile(r"^dtof_library\((\w+)(.*?)\n?\)", re.DOTALL | re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
SECTIONS = re.compile(r"\b(SOURCES|DEPENDS|PRIVATE_DEPENDS|INTERNAL)\b")
LONG_FILE, LONG_FUNCTION = 500, 80
GENERATED = re.compile(r"// ([\w ]+): written by scripts/generate\.py from .*?// end of \1\n", re.DOTALL)
PARAMETER = re.compile(r"\bGUARD\b")  # stands for all parameters
CODE = (".sv", ".svh", ".py", ".cpp", ".hpp", ".c", ".h", ".sh", ".tcl")
PYTHON = (".py", "/Snakefile", ".ci/long")
SYS_PATH = re.compile(r"(?:^|;)[ \t]*sys\.path(?:\.\w+\(|\[[^\]\n]*\] *=|(?: *=| *\+=)(?!=))", re.MULTILINE)
CPP_FUNCTION = re.compile(r"^( {0,2})\S.*\) (?:const |noexcept |override |-> [^{;]+ )*\{$")


def listed(root: Path) -> list[str]:
    return sorted(SourceTree(root).files)


class Library:
    def __init__(self, name: str, folder: str, names: set[str]) -> None:
        self.name, self.folder, self.names = name, folder, names  # names: libraries in its CMakeLists.txt


def libraries(root: Path, files: list[str]) -> dict[str, Library]:
    found: dict[str, Library] = {}
    for file in files:
        if not file.endswith("CMakeLists.txt") or file.partition("/")[0] not in ROOMS:
            continue
        for name, body in LIBRARY.findall((root / file).read_text(encoding="utf-8")):
            parts = SECTIONS.split(body)
            names = {word.removeprefix("dtof_") for section, text in zip(parts[1::2], parts[2::2]) if section.endswith("DEPENDS")
                     for word in text.split() if word.startswith("dtof_")}
            found.setdefault(name, Library(name, str(Path(file).parent), names))
    return found


def reachable(name: str, known: dict[str, Library]) -> set[str]:
    found: set[str] = set()
    waiting = list(known[name].names)
    while waiting:
        one = waiting.pop()
        if one in known and one not in found:
            found.add(one)
            waiting += known[one].names
    return found


def owner(file: str, known: dict[str, Library]) -> str | None:
    """The library with the nearest folder above the file. studies/ as a whole has two libraries."""
    folders = {library.folder: library.name for library in known.values()}
    if file.startswith("studies/"):
        folders["studies"] = "study_app" if re.search(r"_command\.cpp$|/common/(program|scene_list|commands|main)\.", file) else "study"
    for parent in Path(file).parents:
        if str(parent) in folders:
            return folders[str(parent)]
    return None


def arrows(root: Path, files: list[str]) -> list[str]:
    known = libraries(root, files)
    wrong = [f"{library.folder}: the library {library.name} depends on itself by way of others"
             for library in known.values() if library.name in reachable(library.name, known)]
    wrong += [f"{library.folder}: a library of models/ depends on {other} in {known[other].folder}"
              for library in known.values() if library.folder.startswith("models/")
              for other in sorted(library.names & known.keys()) if not known[other].folder.startswith("models/")]
    headers = {file.split("/", 1)[1]: file for file in files if file.endswith(".hpp") and file.partition("/")[0] in ROOMS}
    for file in files:
        if not file.endswith((".cpp", ".hpp")) or "/tests/" in file or file.endswith("_test.cpp") or file.partition("/")[0] not in ROOMS[:5]:
            continue
        name = owner(file, known)
        if name is None or Path(file).name == "main.cpp":
            continue
        allowed = reachable(name, known) | {name}
        for address in INCLUDE.findall((root / file).read_text(encoding="utf-8")):
            other = owner(headers[address], known) if address in headers else None
            if other is not None and other not in allowed:
                wrong.append(f"{file}: includes {address} of {other}, which {name} does not depend on")
    return wrong


def long_functions(root: Path, file: str) -> int:
    text = (root / file).read_text(encoding="utf-8")
    if file.endswith(".py"):
        return sum((node.end_lineno or 0) - node.lineno + 1 > LONG_FUNCTION for node in ast.walk(ast.parse(text))
                   if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    count, begin, indent = 0, 0, ""
    for number, line in enumerate(text.splitlines(), 1):
        if not begin and (match := CPP_FUNCTION.match(line)):
            begin, indent = number, match[1]
        elif begin and line.startswith(f"{indent}}}"):
            count += number - begin + 1 > LONG_FUNCTION
            begin = 0
    return count


def counts(root: Path, files: list[str]) -> dict[str, int]:
    written = re.compile(r"Written by scripts/")
    texts = {file: (root / file).read_text(encoding="utf-8", errors="replace") for file in files if file.endswith((*CODE, *PYTHON, ".toml", ".mk", ".in"))}
    own = {file: text for file, text in texts.items() if not written.search(text[:300])}
    return {
        "files_above_500_lines": sum(text.count("\n") > LONG_FILE for file, text in own.items() if file.endswith(CODE)),
        "functions_above_80_lines": sum(long_functions(root, file) for file in own if file.endswith((".py", ".cpp", ".hpp"))),
        # scripts/templates/ has RTL; what generate.py writes between marks is no list of its own.
        "files_that_name_GUARD": sum(bool(PARAMETER.search(GENERATED.sub("", text))) for file, text in own.items()
                                     if not file.startswith(("hdl/", "models/", "scripts/templates/", "readouts.toml", "parameters.toml", "configurations.toml"))),
        "edits_of_sys_path": sum(len(SYS_PATH.findall(text)) for file, text in own.items() if file.endswith(PYTHON)),
    }


def ratchets(found: dict[str, int], limits: dict[str, int]) -> list[str]:
    wrong = [f"{LIMITS}: no limit for {name}" for name in found.keys() - limits.keys()]
    for name, limit in limits.items():
        if name not in found:
            wrong.append(f"{LIMITS}: nobody counts {name}")
        elif found[name] > limit:
            wrong.append(f"{name.replace('_', ' ')}: {found[name]} instead of at most {limit}")
        elif found[name] < limit:
            wrong.append(f"{name.replace('_', ' ')}: {found[name]} instead of {limit}, good: lower the number in {LIMITS}")
    return wrong


def main() -> int:
    files = listed(ROOT)
    found = counts(ROOT, files)
    wrong = arrows(ROOT, files) + ratchets(found, tomllib.loads((ROOT / LIMITS).read_text(encoding="utf-8")))
    for line in wrong:
        print(f"error: {line}", file=sys.stderr)
    if not wrong:
        print(f"house: {len(libraries(ROOT, files))} libraries include what they depend on; " +
              ", ".join(f"{count} {name.replace('_', ' ')}" for name, count in found.items()))
    return 1 if wrong else 0


if __name__ == "__main__":
    program.run(main)
