# SPDX-License-Identifier: Apache-2.0
"""Pages of studies: each committed page is what its page template makes of the values beside it, and each page template has such values."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

import pages
from figures.reports import page_data
from page.sections import Report

ROOT = Path(__file__).resolve().parents[2]
STUDY = ROOT / "build/cpp/bin/dtof-study"


class FromData(unittest.TestCase):
    """The page keeps its line about its age, and pictures that lie in build/ are named, not shown."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "reports/data").mkdir(parents=True)
        (self.root / "reports/data/range.page.json").write_text("# Range\n\n![Errors](range.svg)\n", encoding="utf-8")

    def made(self, committed: str) -> str:
        (self.root / "reports/range.md").write_text(committed, encoding="utf-8")
        program = self.root / "study"
        program.write_text('#!/bin/sh\n[ "$1" = page ] && cat "$2"\n', encoding="utf-8")
        program.chmod(0o755)
        return pages.from_data(Report("range", "Range", "range", "range.md", "range/range.md"), str(program), self.root)

    PAGE = "# Range\n\n*Errors: this report's command draws the picture in build/, and `make report` shows it.*\n"

    def test_a_page_is_made_from_its_data(self) -> None:
        self.assertEqual(self.made("# Old words\n"), self.PAGE)

    def test_the_line_about_its_age_stays(self) -> None:
        mark = "> Confirmed: changes in hdl.\n\n"
        self.assertEqual(self.made(mark + "# Old words\n"), mark + self.PAGE)

    def test_pages_of_folders_have_data_of_their_own(self) -> None:
        self.assertEqual(page_data("tmf8829/summary.md"), "data/tmf8829_summary.page.json")


NOT_PUBLISHED = {"accuracy", "accuracy_over_a_map", "pool_search"}
# Measured before they had a page template.
WITHOUT_VALUES = {"pool"}


class Committed(unittest.TestCase):
    def test_each_page_template_has_a_page_with_values(self) -> None:
        templates = {path.stem for path in (ROOT / "studies").glob("*/*.mustache")}
        with_values = {json.loads(path.read_text(encoding="utf-8"))["template"] for path in (ROOT / "reports/data").glob("*.page.json")}
        self.assertEqual(templates - with_values, NOT_PUBLISHED | WITHOUT_VALUES)
        self.assertEqual(with_values - templates, set())

    def test_each_page_is_what_its_template_makes_of_its_data(self) -> None:
        if not STUDY.is_file():
            self.skipTest("build/cpp/bin/dtof-study is not built")
        found = subprocess.run([ROOT / "scripts/pages.py", STUDY, "--check"], capture_output=True, text=True)
        self.assertEqual(found.stdout + found.stderr, "")
        self.assertEqual(found.returncode, 0)


if __name__ == "__main__":
    unittest.main()
