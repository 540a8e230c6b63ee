# SPDX-License-Identifier: Apache-2.0
"""`make help` and `make study`."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

import help as targets_help  # noqa: E402
from page.commands import commands, targets  # noqa: E402

MAKEFILE = """# make frames     the room through every read-out (five minutes): reports/frames.md
# make sim        the main job
.PHONY: frames sim inner
"""
REPORTS = """[report.frames]
command = "make frames"
minutes = 5
pages = ["frames.md"]
inputs = ["Makefile"]
"""
LIST = """[[group]]
title = "Every day"
targets = { sim = 0.5 }
[[group]]
title = "Studies"
name = "study"
targets = { frames = "" }
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

    def test_the_list_is_checked(self) -> None:
        self.refused(LIST.replace("sim", "simulate"), "no makefile has the target 'simulate'")
        self.refused(LIST.replace("sim", "inner"), "Makefile: no comment says what the target 'inner' does")
        self.refused(LIST.replace("sim = 0.5", 'sim = ""'), "'sim' needs minutes here, for no report has them")
        self.refused(LIST.replace('frames = ""', "frames = 5"), "'frames' needs minutes \"\", for its report has them")
        self.refused(LIST.replace("sim = 0.5", 'sim = 0.5, frames = ""'), "'frames' stands there twice")

    def test_another_name_than_a_study_is_refused(self) -> None:
        self.assertEqual(targets_help.study(self.root, "frames"), "frames")
        for name, sentence in (("sim", "there is no study 'sim'; studies are frames"), ("", "make study needs NAME=")):
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
