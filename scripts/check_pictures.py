#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures that git keeps under reports/ are few and small, and a document shows each: every renewal stays in the history
for ever. The others are drawn in build/, where `make report` finds them."""

import re
import sys
from pathlib import Path

from dtof_synth import program
from figures.source_tree import SourceTree

ROOT = Path(__file__).resolve().parent.parent
MOST = 10
LARGEST = 200_000  # bytes
PICTURES = (".png", ".svg", ".jpg", ".gif", ".webp", ".pdf")
SHOWN = re.compile(r"!\[[^\]]*\]\(([^)]*)\)")


def problems(root: Path, files: list[str]) -> list[str]:
    """`files`: what git keeps, from `root`."""
    pictures = [file for file in files if file.startswith("reports/") and file.endswith(PICTURES)]
    found = [f"{len(pictures)} pictures under reports/, {MOST} are allowed"] if len(pictures) > MOST else []
    shown = set()
    for file in files:
        if file.endswith(".md"):
            folder = (root / file).parent
            shown |= {(folder / name).resolve() for name in SHOWN.findall((root / file).read_text(encoding="utf-8"))}
    for picture in pictures:
        size = (root / picture).stat().st_size
        if size > LARGEST:
            found.append(f"{picture} has {size} bytes, {LARGEST} are allowed")
        if (root / picture).resolve() not in shown:
            found.append(f"{picture} is shown by no document")
    return found


def main() -> int:
    found = problems(ROOT, sorted(SourceTree(ROOT).files))
    for sentence in found:
        print(f"error: {sentence}", file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    program.run(main)
