# SPDX-License-Identifier: Apache-2.0
"""The files on which a C++ file or a Python script depends: the project files that it names, that those name, and so on."""

import ast
import functools
import re
from pathlib import PurePosixPath

from .source_tree import SourceTree

CPP_ROOTS = ("models", "tb_cpp", "app", "studies", "tests")
PYTHON_ROOTS = ("scripts", "synth")
MEASURES_NOTHING = "scripts/figures/"  # only notes what was measured
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
# A command's file includes the list of all commands first and belongs to none of the headers; the list says nothing of it.
COMMAND = re.compile(r"(_command|main|program)\.cpp$")
TEST = re.compile(r"_test\.cpp$")
COMMANDS = "commands.hpp"


@functools.cache
def _includes(tree: SourceTree, name: str) -> list[str]:
    folder = PurePosixPath(name).parent
    found = []
    for address in INCLUDE.findall(tree.text(name)):
        for candidate in (*(f"{root}/{address}" for root in CPP_ROOTS), str(folder / address), f"{address}"):
            if candidate in tree.files:
                if PurePosixPath(candidate).name != COMMANDS:
                    found.append(candidate)
                break
    return found


@functools.cache
def _sources(tree: SourceTree) -> dict[str, list[str]]:
    """For each header, the files that define its declarations: the file of its name, and files beside it that include it and have no header
    of their own. For each file without a header, all files beside it, which may define its declarations."""
    found: dict[str, list[str]] = {}
    folders: dict[PurePosixPath, list[str]] = {}
    alone = []
    for name in sorted(tree.files):
        if name.partition("/")[0] not in CPP_ROOTS or not name.endswith(".cpp") or COMMAND.search(name) or TEST.search(name):
            continue
        folders.setdefault(PurePosixPath(name).parent, []).append(name)
        own = name.removesuffix(".cpp") + ".hpp"
        if own in tree.files:
            found.setdefault(own, []).append(name)
        else:
            alone.append(name)
    for name in alone:
        folder = PurePosixPath(name).parent
        found[name] = folders[folder]
        for header in _includes(tree, name):
            if PurePosixPath(header).parent == folder:
                found.setdefault(header, []).append(name)
    return found


def cpp(tree: SourceTree, root: str) -> set[str]:
    sources = _sources(tree)
    found: set[str] = set()
    waiting = [root]
    while waiting:
        name = waiting.pop()
        if name not in found and name in tree.files:
            found.add(name)
            waiting += _includes(tree, name) + sources.get(name, [])
    return found


@functools.cache
def _imports(tree: SourceTree, name: str) -> list[str]:
    """Modules of the project that a file imports, with the packages that contain them."""
    place = PurePosixPath(name)
    modules: list[tuple[str, str]] = []  # folder to look in, dotted name
    for node in ast.walk(ast.parse(tree.text(name))):
        if isinstance(node, ast.Import):
            modules += [(folder, alias.name) for alias in node.names for folder in (str(place.parent), *PYTHON_ROOTS)]
        elif isinstance(node, ast.ImportFrom):
            folders = [str(place.parents[node.level - 1])] if node.level else [str(place.parent), *PYTHON_ROOTS]
            base = f"{node.module}." if node.module else ""
            modules += [(folder, base + alias.name) for alias in node.names for folder in folders]
            modules += [(folder, node.module) for folder in folders if node.module]
    found = []
    for folder, module in modules:
        path = f"{folder}/{module.replace('.', '/')}"
        found += [candidate for candidate in (f"{path}.py", f"{path}/__init__.py") if candidate in tree.files]
    return found


def python(tree: SourceTree, root: str) -> set[str]:
    found: set[str] = set()
    waiting = [root]
    while waiting:
        name = waiting.pop()
        if name not in found and name in tree.files and not name.startswith(MEASURES_NOTHING):
            found.add(name)
            waiting += _imports(tree, name)
    return found
