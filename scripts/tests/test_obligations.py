# SPDX-License-Identifier: Apache-2.0
"""The integrator's obligations name assertions, flags and files that exist."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "user" / "integration.md"
ROW = re.compile(r"^\| (\d+) \| .+ \| (.+) \|$", re.MULTILINE)


def rows(text: str) -> list[tuple[int, str]]:
    """(number, what notices)."""
    return [(int(number), notices) for number, notices in ROW.findall(text.split("## What an integrator owes\n", 1)[1])]


def problems(text: str, assertions: set[str], flags: set[str]) -> list[str]:
    found = []
    for number, notices in rows(text):
        named = set(re.findall(r"`(a_\w+)`", notices)) - assertions
        named |= {flag for flag in re.findall(r"`ERROR\.(\w+)`", notices) if flag not in flags}
        found += [f"{number}: '{name}' does not exist" for name in sorted(named)]
        if "nothing" not in notices.lower() and "`" not in notices and "tool" not in notices:
            found.append(f"{number}: nothing is named that notices it")
    return found


def assertions() -> set[str]:
    text = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "hdl").rglob("*.sv"))
    return set(re.findall(r"`DTOF_ASSERT\((a_\w+),", text))


def flags() -> set[str]:
    return set(re.findall(r"\bERROR_(\w+)_LSB\b", (ROOT / "hdl/subsystem/dtof_registers_pkg.sv").read_text(encoding="utf-8")))


class Obligations(unittest.TestCase):
    def test_they_are_numbered_and_name_what_exists(self) -> None:
        text = PAGE.read_text(encoding="utf-8")
        self.assertEqual([number for number, _ in rows(text)], list(range(1, len(rows(text)) + 1)))
        self.assertGreaterEqual(len(rows(text)), 12)
        self.assertEqual(problems(text, assertions(), flags()), [])

    def test_a_name_that_does_not_exist_is_found(self) -> None:
        text = "## What an integrator owes\n| 1 | x | `a_gone`; `ERROR.GONE` |\n| 2 | x | a look |\n"
        self.assertEqual(problems(text, {"a_there"}, {"THERE"}),
                         ["1: 'GONE' does not exist", "1: 'a_gone' does not exist", "2: nothing is named that notices it"])


if __name__ == "__main__":
    unittest.main()
