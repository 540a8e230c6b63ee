# SPDX-License-Identifier: Apache-2.0
"""scripts/coverage.py counts lines, branches and toggles, and fails for a hole that nobody explains."""

import importlib.util
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
_spec = importlib.util.spec_from_file_location("coverage_report", ROOT / "scripts" / "coverage.py")
assert _spec is not None and _spec.loader is not None
coverage = importlib.util.module_from_spec(_spec)
sys.modules["coverage_report"] = coverage
_spec.loader.exec_module(coverage)

FILE = "hdl/thesis/dtof_peak_detector.sv"


def point(count: int, **keys: str) -> str:
    return "C '" + "".join(f"\1{key}\2{value}" for key, value in keys.items()) + f"' {count}\n"


def counts(ran: int) -> str:
    return (
        "# SystemC::Coverage-3\n"
        + point(5, f=FILE, l="3", n="3", page="v_line", o="block", S="3-4,10")
        + point(ran, f=FILE, l="5", n="5", page="v_branch", o="if", S="5-6")
        + point(5, f=FILE, l="5", n="6", page="v_branch", o="else")
        + point(0, f=FILE, l="2", n="1", page="v_toggle", o="count_q[0]")
        + point(3, f=FILE, l="2", n="1", page="v_toggle", o="count_q[0]")
        + point(0, f=FILE, l="2", n="1", page="v_toggle", o="count_q[1]")
        + point(0, f="tb_cpp/rtl/dtof_array_testbench.sv", l="9", n="1", page="v_line", o="block", S="9")
    )


class CoverageTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "cpp.json").write_text(
            '{"files": [{"filename": "models/dtof/core/random.cpp", "line_covered": 3, "line_total": 4,'
            ' "branch_covered": 1, "branch_total": 2}]}')

    def run_report(self, text: str, plan: str) -> tuple[int, str]:
        (self.folder / "rtl.dat").write_text(text)
        (self.folder / "testplan.md").write_text(plan)
        arguments = ["coverage.py"] + [str(self.folder / name) for name in ("rtl.dat", "cpp.json", "report.md")]
        with mock.patch.object(sys, "argv", arguments), mock.patch("builtins.print"), \
                mock.patch.object(coverage, "TEST_PLAN", self.folder / "testplan.md"):
            status = coverage.main()
        return status, (self.folder / "report.md").read_text()

    def test_lines_branches_and_toggles_are_counted_once_per_place(self) -> None:
        (self.folder / "rtl.dat").write_text(counts(1))
        files = coverage.read_rtl(self.folder / "rtl.dat")
        self.assertEqual(list(files), [FILE])
        self.assertEqual(coverage.counted(files[FILE].lines), coverage.Counter(5, 5))
        self.assertEqual(coverage.counted(files[FILE].branches), coverage.Counter(2, 2))
        self.assertEqual(coverage.counted(files[FILE].toggles), coverage.Counter(1, 2))

    def test_everything_ran(self) -> None:
        status, report = self.run_report(counts(1), "")
        self.assertEqual(status, 0)
        self.assertIn("100.0 % of the RTL's lines ran; the goal of 98 % is met", report)
        self.assertIn("| `models/dtof/core` | 3 of 4 (75.0 %) | 1 of 2 (50.0 %) |", report)

    def test_a_line_that_did_not_run_misses_the_goal(self) -> None:
        status, report = self.run_report(counts(0), "")
        self.assertEqual(status, 1)
        self.assertIn("60.0 % of the RTL's lines ran; the goal of 98 % is **missed**", report)
        self.assertIn("2 lines did not run, 0 of them are explained", report)

    def test_a_hole_must_be_explained(self) -> None:
        lines = (ROOT / FILE).read_text().splitlines()
        plan = "".join(f"| `{FILE}` | `{lines[line - 1].strip()}` | a reason |\n" for line in (5, 6))
        with mock.patch.object(coverage, "GOAL_PERCENT", 50.0):
            self.assertEqual(self.run_report(counts(0), plan)[0], 0)
            self.assertEqual(self.run_report(counts(0), plan.splitlines()[0])[0], 1)


if __name__ == "__main__":
    unittest.main()
