#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the project's files whose names end in one of the arguments: list_files.py .cpp .hpp driver/dtof.h"""

import sys
from pathlib import Path

from dtof_synth import program
from figures.source_tree import SourceTree


def main() -> None:
    tree = SourceTree(Path(__file__).resolve().parent.parent)
    print("\n".join(sorted(name for name in tree.files if name.endswith(tuple(sys.argv[1:])))))


if __name__ == "__main__":
    program.run(main)
