# SPDX-License-Identifier: Apache-2.0
"""`make help` and `make study`."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import help as targets_help
from figures import reports
from page.commands import commands, targets

ROOT = Path(__file__).resolve().parents[2]
MAKEFILE = """# make sim        the main job
# make synth      area of every configuration
.PHONY: frames search sim synth inner
"""
STUDIES = """[study.frames]
does = "the room through every read-out; all of them"
minutes = 5
inputs = ["Makefile"]
[[study.frames.page]]
file = "frames.md"
title = "Frames"
[study.search]
does = "a search that no page shows"
minutes = 30
"""
REPORTS = """[report.area]
command = "make synth"
minutes = 40
pages = ["area.md"]
inputs = ["Makefile"]
"""
LIST = """[[group]]
title = "Every day"
targets = { sim = 0.5, synth = "" }
[[group]]
title = "Studies"
studies = true
"""


class SmallProject(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for name in ("scripts", "reports"):
            (self.root / name).mkdir()
        self.write(LIST)
        (self.root / "reports" / "reports.toml").write_text(REPORTS)
        (self.root / "Makefile").write_text(MAKEFILE)
        (self.root / "studies.toml").write_text(STUDIES)

    def write(self, text: str) -> None:
        (self.root / targets_help.LIST).write_text(text)

    def refused(self, text: str, sentence: str) -> None:
        self.write(text)
        with self.assertRaisesRegex(targets_help.HelpError, sentence):
            targets_help.load(self.root)

    def test_a_target_has_its_minutes_and_the_first_clause_of_its_comment(self) -> None:
        text = targets_help.text(self.root, everything=False)
        self.assertRegex(text, r"\n  frames +5 min  the room through every read-out\n")
        self.assertRegex(text, r"\n  sim +seconds  the main job\n")
        self.assertRegex(text, r"\n  search +30 min  a search that no page shows\n")

    def test_the_list_is_checked(self) -> None:
        self.refused(LIST.replace("sim", "simulate"), "no makefile has the target 'simulate'")
        self.refused(LIST.replace("sim", "inner"), "Makefile: no comment says what the target 'inner' does")
        self.refused(LIST.replace("sim = 0.5", 'sim = ""'), "'sim' needs minutes here, for no report has them")
        self.refused(LIST.replace('synth = ""', "synth = 5"), "'synth' needs minutes \"\", for its report has them")
        self.refused(LIST.replace("sim = 0.5", 'sim = 0.5, frames = ""'), "'frames' stands there twice")

    def test_studies_are_those_of_their_list(self) -> None:
        self.assertEqual(commands(self.root)["search"].says, "a search that no page shows")
        (self.root / "Makefile").write_text(MAKEFILE.replace("frames search", "frames"))
        self.refused(LIST, "no makefile has the target 'search'")
        (self.root / "Makefile").write_text("# make search  says it again\n" + MAKEFILE)
        with self.assertRaisesRegex(reports.ReportsError, "studies.toml says what 'search' does"):
            targets_help.load(self.root)
        (self.root / "studies.toml").write_text(STUDIES.replace("minutes = 30\n", ""))
        with self.assertRaisesRegex(reports.ReportsError, "studies.toml: search: the key 'minutes' is missing"):
            targets_help.load(self.root)

    def test_another_name_than_a_study_is_refused(self) -> None:
        self.assertEqual(targets_help.study(self.root, "frames"), "frames")
        for name, sentence in (("sim", "there is no study 'sim'; studies are frames, search"), ("", "make study needs NAME=")):
            with self.assertRaisesRegex(targets_help.HelpError, sentence):
                targets_help.study(self.root, name)


class Project(unittest.TestCase):
    def test_the_first_page_has_at_most_twenty_targets_beside_the_studies(self) -> None:
        public = [target for group in targets_help.load(ROOT) if not group.is_study for target in group.minutes]
        self.assertLessEqual(len(public), 20)

    def test_all_described_targets_are_on_the_long_page(self) -> None:
        text = targets_help.text(ROOT, everything=True)
        for target in commands(ROOT):
            self.assertRegex(text, rf"\n  {target} ")
        self.assertGreaterEqual(len(commands(ROOT)), len(targets(ROOT)) - 8)

    def test_the_readme_is_short(self) -> None:
        self.assertLessEqual(len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()), 120)

    @unittest.skipUnless(shutil.which("make"), "make is absent")
    def test_make_prints_it(self) -> None:
        done = subprocess.run(["make", "--no-print-directory", "help"], cwd=ROOT, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout.rstrip()), (0, targets_help.text(ROOT, everything=False)))
        done = subprocess.run(["make", "--no-print-directory", "study", "NAME=nothing"], cwd=ROOT, capture_output=True, text=True)
        self.assertIn("error: there is no study 'nothing'", done.stderr)
        self.assertNotEqual(done.returncode, 0)


if __name__ == "__main__":
    unittest.main()
