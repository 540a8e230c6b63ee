# SPDX-License-Identifier: Apache-2.0
"""Mutants that every run judges (remembered.toml)."""

import tomllib
from pathlib import Path

from mutation.mutant import Mutant
from mutation.verdict import MutationError

REMEMBERED = Path(__file__).resolve().parent / "remembered.toml"


def load(tree: Path, folder: str, path: Path = REMEMBERED) -> list[Mutant]:
    """Remembered mutants of the sources below a folder of `tree`. The text that each changes must occur exactly once."""
    found = []
    for entry in tomllib.loads(path.read_text(encoding="utf-8"))["mutant"]:
        if not entry["file"].startswith(f"{folder}/"):
            continue
        text = (tree / entry["file"]).read_text(encoding="utf-8")
        if text.count(entry["original"]) != 1:
            raise MutationError(f"{path.name}: {entry['file']} has '{entry['original']}' not exactly once")
        begin = text.index(entry["original"])
        line = text.count("\n", 0, begin) + 1
        found.append(
            Mutant(
                file=entry["file"],
                line=line,
                begin=begin,
                end=begin + len(entry["original"]),
                original=entry["original"],
                mutated=entry["mutated"],
                operator="remembered",
                source=text.splitlines()[line - 1].strip(),
                above=text.splitlines()[line - 2].strip(),
                place=begin,
            )
        )
    return found
