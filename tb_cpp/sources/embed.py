#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""embed.py ROOT OUT FILE...: writes OUT, C++ that holds the texts of the files, named from ROOT on."""

import sys
from pathlib import Path

MARK = "source~text"  # no file has )source~text"


def main() -> int:
    root, out, files = Path(sys.argv[1]), Path(sys.argv[2]), [Path(name) for name in sys.argv[3:]]
    lines = ["// SPDX-License-Identifier: Apache-2.0", "// Written by tb_cpp/sources/embed.py.", '#include "sources/sources.hpp"', "",
             "#include <array>", "", "namespace dtof {", "namespace {", "",
             "using namespace std::string_view_literals;  // which know their length", "",
             f"constexpr std::array<SourceFile, {len(files)}> kFiles = {{{{"]
    for file in sorted(files):
        text = file.read_text(encoding="utf-8")
        if f"){MARK}\"" in text:
            print(f"error: {file} has )" + MARK, file=sys.stderr)
            return 1
        lines.append(f'    {{"{file.relative_to(root).as_posix()}"sv, R"{MARK}({text}){MARK}"sv}},')
    lines += ["}};", "", "}  // namespace", "", "std::span<const SourceFile> project_sources() { return kFiles; }", "", "}  // namespace dtof", ""]
    out.write_text("\n".join(lines), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
