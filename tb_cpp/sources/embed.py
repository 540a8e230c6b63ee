#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes OUT, C++ that holds the texts of the files, named from ROOT on. `function` returns them as a span of `struct`, which the header declares."""

import argparse
import sys
from pathlib import Path

MARK = "source~text"  # no file has )source~text


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--struct", default="SourceFile")
    parser.add_argument("--function", default="project_sources")
    parser.add_argument("--header", default="sources/sources.hpp")
    parser.add_argument("root", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("files", type=Path, nargs="+")
    arguments = parser.parse_args()
    lines = ["// SPDX-License-Identifier: Apache-2.0", "// Written by tb_cpp/sources/embed.py.", f'#include "{arguments.header}"', "",
             "#include <array>", "", "namespace dtof {", "namespace {", "",
             "using namespace std::string_view_literals;  // which know their length", "",
             f"constexpr std::array<{arguments.struct}, {len(arguments.files)}> kFiles = {{{{"]
    for file in sorted(arguments.files):
        text = file.read_text(encoding="utf-8")
        if f"){MARK}\"" in text:
            print(f"error: {file} has )" + MARK, file=sys.stderr)
            return 1
        lines.append(f'    {{"{file.relative_to(arguments.root).as_posix()}"sv, R"{MARK}({text}){MARK}"sv}},')
    lines += ["}};", "", "}  // namespace", "", f"std::span<const {arguments.struct}> {arguments.function}() {{ return kFiles; }}", "",
              "}  // namespace dtof", ""]
    arguments.out.write_text("\n".join(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
