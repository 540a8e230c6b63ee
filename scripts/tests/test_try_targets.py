# SPDX-License-Identifier: Apache-2.0
"""Targets of a small project, some of them broken."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import try_targets
from page.commands import targets

ROOT = Path(__file__).resolve().parents[2]
MAKEFILE = """.PHONY: first second written slow
first:
\t@mkdir -p build && echo $(SMALL) > build/first && echo run >> ../ran
second:
\t@cat build/first
written:
\t@echo changed > reports/page.md
slow:
\t@sleep 60
"""
PLANS = """first = {}
second = { after = ["first"] }
written = { writes = ["reports/page.md"] }
slow = { long = "a minute" }
"""


class Project:
    """A repository with a makefile, the list of targets and a report."""

    def __init__(self, folder: Path) -> None:
        self.root = folder
        for name in ("scripts", "synth", "reports"):
            (folder / name).mkdir()
        (folder / ".gitignore").write_text("build/\n")
        (folder / "reports" / "page.md").write_text("measured\n")
        self.git("init", "--quiet")
        self.write(MAKEFILE, PLANS)

    def git(self, *arguments: str) -> None:
        subprocess.run(["git", "-C", self.root, "-c", "user.name=Test", "-c", "user.email=test@example.org", *arguments], check=True)

    def write(self, makefile: str, plans: str) -> None:
        (self.root / "Makefile").write_text(makefile)
        (self.root / try_targets.LIST).write_text(plans)
        self.git("add", ".")
        self.git("commit", "--quiet", "--message", "state")

    def run(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([sys.executable, "-B", ROOT / "scripts" / "try_targets.py", "--root", self.root, *arguments],
                              capture_output=True, text=True)

    def results(self) -> dict[str, dict]:
        return json.loads((self.root / "build" / "try" / "results.json").read_text())


class TryTargets(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.project = Project(Path(folder.name))

    def test_targets_pass_on_little_work_in_a_copy(self) -> None:
        done = self.project.run()
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("3 targets passed, 0 failed, 0 skipped, 1 not tried", done.stdout)
        self.assertRegex(done.stdout, r"slow +not tried: a minute")
        self.assertEqual((self.project.root / "build" / "try" / "second.log").read_text().splitlines()[-1], "1")
        self.assertEqual((self.project.root / "reports" / "page.md").read_text(), "measured\n")
        self.assertFalse((self.project.root / "build" / "first").exists())

    def test_targets_run_in_this_folder(self) -> None:
        done = self.project.run("--here")
        self.assertIn("3 targets passed", done.stdout, done.stderr)
        self.assertEqual((self.project.root / "build" / "first").read_text(), "1\n")
        self.assertEqual((self.project.root / "reports" / "page.md").read_text(), "measured\n")

    def test_a_change_that_is_not_committed_is_not_lost(self) -> None:
        (self.project.root / "reports" / "page.md").write_text("mine\n")
        done = self.project.run("--here")
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("--here: reports/page.md is not committed, and would be lost", done.stderr)
        self.assertEqual((self.project.root / "reports" / "page.md").read_text(), "mine\n")

    def test_a_broken_target_is_found_and_the_others_are_tried(self) -> None:
        self.project.write(MAKEFILE.replace("@cat build/first", "@cat build/another"), PLANS)
        done = self.project.run()
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stdout, r"second +\d+ s  FAILED: status 2, see build/try/second.log")
        self.assertRegex(done.stdout, r"written +\d+ s  passed")
        self.assertIn("error: these targets failed: second\n", done.stderr)
        self.assertIn("another", (self.project.root / "build" / "try" / "second.log").read_text())

    def test_what_reads_a_broken_targets_files_fails_too(self) -> None:
        self.project.write(MAKEFILE.replace("@mkdir -p build", "@false"), PLANS)
        done = self.project.run("second")
        self.assertRegex(done.stdout, r"second +FAILED: it reads what `make first` leaves")
        self.assertIn("these targets failed: first second", done.stderr)

    def test_a_target_that_changes_a_report_is_broken(self) -> None:
        self.project.write(MAKEFILE, PLANS.replace('writes = ["reports/page.md"]', ""))
        done = self.project.run()
        self.assertEqual(done.returncode, 1)
        self.assertIn("FAILED: it changed reports/page.md", done.stdout)

    def test_a_target_that_nobody_tries_is_an_error_before_anything_runs(self) -> None:
        self.project.write(MAKEFILE + ".PHONY: added\nadded:\n\t@true\n", PLANS)
        done = self.project.run()
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, "error: Makefile: nobody tries the target 'added': say in scripts/try_targets.toml how\n")
        self.assertFalse((self.project.root / "build" / "try" / "ran").exists())

    def test_a_target_that_is_gone_is_an_error(self) -> None:
        self.project.write(MAKEFILE, PLANS + "gone = {}\n")
        self.assertIn("no makefile has the target 'gone'", self.project.run().stderr)

    def test_what_passed_is_passed_over_until_the_next_commit(self) -> None:
        ran = self.project.root / "build" / "try" / "ran"
        for count, arguments in ((1, ()), (1, ()), (2, ("--again",))):
            self.assertEqual(self.project.run(*arguments).returncode, 0)
            self.assertEqual(len(ran.read_text().splitlines()), count)
        self.project.write(MAKEFILE + "# another commit\n", PLANS)
        self.project.run()
        self.assertEqual(len(ran.read_text().splitlines()), 3)
        self.assertEqual(self.project.results().keys(), {"first", "second", "written"})

    def test_what_is_not_here_is_said(self) -> None:
        self.project.write(MAKEFILE, PLANS.replace("first = {}", 'first = { needs = ["no-such-program"] }'))
        self.assertRegex(self.project.run("first").stdout, r"first +skipped: no-such-program is not here")

    def test_a_target_that_does_not_end_fails(self) -> None:
        self.project.write(MAKEFILE, PLANS.replace('long = "a minute"', ""))
        self.assertIn("FAILED: still ran after 0.01 minutes", self.project.run("slow", "--minutes", "0.01").stdout)

    def test_quick_leaves_long_targets_out(self) -> None:
        self.project.write(MAKEFILE, PLANS.replace("written = {", "written = { minutes = 5,"))
        done = self.project.run("--quick")
        self.assertNotIn("written", done.stdout)
        self.assertIn("2 targets passed", done.stdout)


class TheList(unittest.TestCase):
    def test_has_every_target_of_the_makefiles(self) -> None:
        self.assertEqual(try_targets.load(ROOT).keys(), targets(ROOT).keys())


if __name__ == "__main__":
    unittest.main()
