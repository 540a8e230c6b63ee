#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the types of every Python file of the project with mypy; the settings are in pyproject.toml.

mypy refuses two modules with the same name, and each folder of tests is a package `tests`. The files are therefore checked in groups in which
every name stands once.
"""

import subprocess
from pathlib import Path, PurePosixPath

from dtof_synth import program
from figures.source_tree import SourceTree

ROOT = Path(__file__).resolve().parent.parent
MYPY = "/usr/bin/mypy"


def python_files(tree: SourceTree) -> list[str]:
    """Modules, stubs, and programs without a suffix whose first line names Python."""
    return sorted(name for name in tree.files if name.endswith((".py", ".pyi")) or (
        not PurePosixPath(name).suffix and b"python" in (line := tree.read(name).partition(b"\n")[0]) and line.startswith(b"#!")))


def modules(name: str, known: frozenset[str]) -> dict[str, str]:
    """The module that mypy sees in a file, and its packages: each name with the file that defines the name."""
    path = PurePosixPath(name)
    found = [(path.stem, name)] if path.stem != "__init__" else []
    folder = path.parent
    while f"{folder}/__init__.py" in known:
        found = [(f"{folder.name}.{inner}", file) for inner, file in found] + [(folder.name, f"{folder}/__init__.py")]
        folder = folder.parent
    return dict(found)


def groups(files: list[str]) -> list[list[str]]:
    """Every file in one group, in each group every module's name once."""
    known = frozenset(files)
    taken: list[dict[str, str]] = []
    found: list[list[str]] = []
    for name in files:
        own = modules(name, known)
        for names, group in zip(taken, found):
            if all(names.get(module, file) == file for module, file in own.items()):
                names.update(own)
                group.append(name)
                break
        else:
            taken.append(own)
            found.append([name])
    return found


def failures(root: Path, files: list[str]) -> list[str]:
    """What mypy says of each group that it does not accept."""
    found = []
    for group in groups(files):
        done = subprocess.run([MYPY, "--cache-dir", "build/mypy", "--no-error-summary", *group], cwd=root, capture_output=True, text=True)
        if done.returncode != 0:
            found.append(done.stdout + done.stderr)
    return found


def main() -> int:
    files = python_files(SourceTree(ROOT))
    found = failures(ROOT, files)
    print("".join(found) if found else f"mypy: {len(files)} files clean")
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
