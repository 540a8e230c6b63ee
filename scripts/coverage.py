#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the coverage report from Verilator's merged counts and gcovr's summary.

`coverage.py <rtl.dat> <cpp.json> <report.md>`. Fails if fewer of the RTL's lines ran than the goal says, or if a line
that did not run is not explained in docs/reference/testplan.md.

A line of the RTL has run if every block of statements on it has; lines without statements (declarations,
continuous assignments) do not count. A branch is one way out of an `if` or one arm of a `case`. A toggle is one bit
of a signal that changed at least once.
"""

import json
import re
import sys
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path

from dtof_synth import program

ROOT = Path(__file__).resolve().parent.parent
TEST_PLAN = ROOT / "docs" / "reference" / "testplan.md"
GOAL_PERCENT = 98.0
POINT = re.compile(r"^C '(?P<keys>.*)' (?P<count>\d+)$")


@dataclass
class Counter:
    """Number of items, and how many of them were reached."""

    reached: int = 0
    of: int = 0

    def add(self, other: "Counter") -> None:
        self.reached += other.reached
        self.of += other.of

    def percent(self) -> float:
        return 100.0 * self.reached / self.of if self.of else 100.0

    def text(self) -> str:
        return f"{self.reached} of {self.of} ({self.percent():.1f} %)" if self.of else "-"


@dataclass
class RtlFile:
    lines: dict[int, bool] = field(default_factory=dict)
    branches: dict[tuple[int, int, str], bool] = field(default_factory=dict)
    toggles: dict[tuple[int, int, str], bool] = field(default_factory=dict)

    def holes(self) -> list[int]:
        return sorted(line for line, ran in self.lines.items() if not ran)


def counted(points: dict) -> Counter:
    return Counter(sum(points.values()), len(points))


def line_numbers(ranges: str) -> list[int]:
    """The numbers in a list such as "3-5,8"."""
    numbers: list[int] = []
    for part in ranges.split(","):
        first, _, last = part.partition("-")
        numbers += range(int(first), int(last or first) + 1)
    return numbers


def read_rtl(path: Path) -> dict[str, RtlFile]:
    files: dict[str, RtlFile] = defaultdict(RtlFile)
    for text in path.read_text().splitlines():
        match = POINT.match(text)
        if match is None:
            continue
        keys = dict(key.split("\2", 1) for key in match["keys"].split("\1") if key)
        if not keys["f"].startswith("hdl/"):
            continue
        file = files[keys["f"]]
        reached = int(match["count"]) > 0
        place = (int(keys["l"]), int(keys["n"]), keys["o"])
        if keys["page"] == "v_toggle":
            file.toggles[place] = file.toggles.get(place, False) or reached
            continue
        if keys["page"] == "v_branch" or keys["o"] == "case":
            file.branches[place] = file.branches.get(place, False) or reached
        for line in line_numbers(keys["S"]) if "S" in keys else []:
            file.lines[line] = file.lines.get(line, True) and reached
    return dict(sorted(files.items()))


def read_cpp(path: Path) -> dict[str, tuple[Counter, Counter]]:
    """Counters of lines and branches for each library."""
    libraries: dict[str, tuple[Counter, Counter]] = defaultdict(lambda: (Counter(), Counter()))
    for file in json.loads(path.read_text())["files"]:
        parts = file["filename"].split("/")
        library = "/".join(parts[:3 if parts[0] == "models" else 2])
        lines, branches = libraries[library]
        lines.add(Counter(file["line_covered"], file["line_total"]))
        branches.add(Counter(file["branch_covered"], file["branch_total"]))
    return dict(sorted(libraries.items()))


def explanations() -> set[tuple[str, str]]:
    """File and text of each line that docs/reference/testplan.md explains: rows "| `file` | `text` | why |"."""
    rows = re.findall(r"^\| `(hdl/[^`]*)` \| `([^`]*)` \| .+ \|$", TEST_PLAN.read_text(), re.MULTILINE)
    return set(rows)


def table(header: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(header) + " |", "|---|" + "---:|" * (len(header) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def main() -> int:
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    rtl = read_rtl(Path(sys.argv[1]))
    cpp = read_cpp(Path(sys.argv[2]))

    sums = [Counter(), Counter(), Counter()]
    rows = []
    holes = []
    for name, file in rtl.items():
        counters = [counted(file.lines), counted(file.branches), counted(file.toggles)]
        for total, counter in zip(sums, counters):
            total.add(counter)
        rows.append([f"`{name}`"] + [counter.text() for counter in counters])
        source = (ROOT / name).read_text().splitlines()
        holes += [(name, line, source[line - 1].strip()) for line in file.holes()]
    rows.append(["all"] + [counter.text() for counter in sums])

    cpp_sums = [Counter(), Counter()]
    cpp_rows = []
    for library, of_library in cpp.items():
        for total, counter in zip(cpp_sums, of_library):
            total.add(counter)
        cpp_rows.append([f"`{library}`"] + [counter.text() for counter in of_library])
    cpp_rows.append(["all"] + [counter.text() for counter in cpp_sums])

    explained = explanations()
    unexplained = [hole for hole in holes if hole[::2] not in explained]
    lines = sums[0].percent()
    reached = lines >= GOAL_PERCENT
    report = (
        "# Coverage\n\n"
        "What the C++ tests reach (`make coverage`): the RTL in the arrays of `tb_cpp/tests/rtl` and the read-outs of "
        "`configurations.toml`, and the C++ libraries. A line of the RTL has run if every block of statements on it "
        "has; declarations and continuous assignments have no lines, but toggles: bits that changed at least once in "
        "any array. Verilator counts no line in assertions that hold.\n\n"
        f"- {lines:.1f} % of the RTL's lines ran; the goal of {GOAL_PERCENT:.0f} % is "
        f"{'met' if reached else '**missed**'}.\n"
        f"- {len(holes)} lines did not run, {len(holes) - len(unexplained)} of them are explained in "
        "docs/reference/testplan.md.\n\n"
        "## RTL\n\n" + table(["file", "lines", "branches", "toggles"], rows)
    )
    if holes:
        report += "\nLines that did not run:\n\n" + "".join(
            f"- `{name}:{line}` `{text}`\n" for name, line, text in holes
        )
    report += "\n## C++\n\n" + table(["library", "lines", "branches"], cpp_rows)
    Path(sys.argv[3]).write_text(report)
    print(report)
    for name, line, text in unexplained:
        print(f"{name}:{line}: did not run and is not explained in docs/reference/testplan.md: {text}", file=sys.stderr)
    return 0 if reached and not unexplained else 1


if __name__ == "__main__":
    program.run(main)
