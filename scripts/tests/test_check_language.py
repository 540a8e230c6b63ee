# SPDX-License-Identifier: Apache-2.0
"""Sentences that the lint refuses."""

import unittest
from pathlib import Path

import check_language

ROOT = Path(__file__).resolve().parents[2]


class Language(unittest.TestCase):
    def test_sentences_without_a_noun(self) -> None:
        o = "Of"
        for name, line in (("a.hpp", f"/// {o} all rows."), ("a.py", f'    """{o} a sweep\'s jobs."""'), ("a.tcl", f"# {o} each pin"),
                           ("hdl/a.sv", f"  x = 1;  // {o} a pixel"), ("docs/a.md", f"It is so. {o} the others one is."),
                           ("docs/a.md", f"{o} a column one row counts."), ("docs/a.md", f"| a | {o} the array |"), ("studies/a/a.mustache", f"{{{{a}}}} rows. {o} the others one is.")):
            self.assertIn("begins with", check_language.problem(name, line), line)

    def test_wires_that_hear(self) -> None:
        self.assertIn("'hears' in the RTL", check_language.problem("hdl/column/a.sv", "// a column hears its neighbour"))
        self.assertEqual(check_language.problem("scripts/a.py", "# a user hears"), "")
        self.assertEqual(check_language.problem("hdl/column/a.sv", "assign heard_o = 1;"), "")

    def test_other_verbs_of_people(self) -> None:
        for verb, line in (("wants", "// the sink wants a word"), ("told", "// what the columns are told"), ("forgets", "// it forgets a line")):
            self.assertIn(f"'{verb}' in the RTL", check_language.problem("hdl/pool/a.sv", line))
            self.assertEqual(check_language.problem("app/a.cpp", line), "")
        self.assertEqual(check_language.problem("hdl/pool/a.sv", "logic told_read;  // a command"), "")
        for line in ("  const auto told = message(row);", "if (hears_other_columns(readout)) {", "add(told.front());"):
            self.assertIn("the name '", check_language.problem("models/dtof/a.cpp", line))
        for line in ('stored("told-fog");', "// a pulse cannot be told apart"):
            self.assertEqual(check_language.problem("models/dtof/a.cpp", line), "")
        self.assertIn("'hear' on a page", check_language.problem("docs/a.md", "Columns hear each other."))

    def test_what_there_is_not(self) -> None:
        there = "that there"
        for name, line in (("a.hpp", f"/// Throws for a name {there} is not."), ("docs/a.md", f"0 for one {there} is not"),
                           ("a.py", f"# counts for those {there} are")):
            self.assertIn("say what exists", check_language.problem(name, line), line)
        self.assertEqual(check_language.problem("docs/a.md", f"It proves {there} is a second object."), "")

    def test_good_sentences(self) -> None:
        for name, line in (("a.hpp", "/// The rows of a frame."), ("a.py", "x = 1  # Office"), ("docs/a.md", "Most of them are here."),
                           ("docs/a.md", "## Of")):
            self.assertEqual(check_language.problem(name, line), "")

    def test_the_project(self) -> None:
        self.assertEqual(check_language.problems(ROOT), [])


if __name__ == "__main__":
    unittest.main()
