# SPDX-License-Identifier: Apache-2.0
"""scripts/cases.py, and the quick ones of the cases themselves."""

import io
import tempfile
import unittest
from contextlib import redirect_stdout
from pathlib import Path
from unittest import mock

import case_tools
import cases

ROOT = Path(__file__).resolve().parents[2]


def run(*arguments: str) -> tuple[int, str]:
    with redirect_stdout(io.StringIO()) as out:
        status = cases.main(list(arguments))
    return status, out.getvalue()


def wrong(_case: cases.Case) -> None:
    raise case_tools.CaseError("7 instead of 8")


class Script(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.enterContext(mock.patch.object(cases, "DTOF", Path(__file__)))

    def test_a_folder_that_is_absent_is_skipped(self) -> None:
        self.assertEqual(run(str(self.folder / "none")), (0, f"skipped: {self.folder / 'none'} is absent\n"))

    def test_a_program_that_is_not_built_is_an_error(self) -> None:
        with mock.patch.object(cases, "DTOF", self.folder / "dtof"):
            status, out = run(str(self.folder))
        self.assertEqual(status, 1)
        self.assertIn("is not built", out)

    def test_every_folder_needs_a_rule_that_holds(self) -> None:
        for name in ("good", "bad", "unknown", "long"):
            (self.folder / name).mkdir()
        (self.folder / "README.md").write_text("no case")
        with mock.patch.dict(cases.QUICK, {"good": lambda case: None, "bad": wrong}), mock.patch.dict(cases.SLOW, {"long": wrong}):
            status, out = run(str(self.folder), "--quick")
            self.assertEqual(status, 1)
            self.assertRegex(out, r"(?s)bad .*FAILED: 7 instead of 8\ngood .* good\nunknown .*FAILED: no rule says what is expected\n1 of 3 cases")
            self.assertRegex(run(str(self.folder))[1], r"long .*FAILED")
            status, out = run(str(self.folder), "--only", "good")
            self.assertEqual((status, out.splitlines()[-1]), (0, "1 of 1 cases"))

    def test_no_rule_has_two_paces(self) -> None:
        self.assertFalse(cases.QUICK.keys() & cases.SLOW.keys())


class Tools(unittest.TestCase):
    def test_refusals_are_one_line_with_status_1(self) -> None:
        case_tools.refused(case_tools.Done(1, "", "dtof: error: a\n"), "a")
        for done in (case_tools.Done(0, "", "dtof: error: a\n"), case_tools.Done(1, "", "a\nb\n"), case_tools.Done(1, "", "b\n"),
                     case_tools.Done(-6, "", "a\n")):  # fmt: skip
            with self.subTest(done=done), self.assertRaises(case_tools.CaseError):
                case_tools.refused(done, "a")

    def test_depths_are_compared_one_by_one(self) -> None:
        case_tools.require_depths([1000, 0], [1.01, None], "map")
        for measured in ([1000, 500], [1020, 0], [0, 0]):
            with self.subTest(measured=measured), self.assertRaisesRegex(case_tools.CaseError, "map: pixel"):
                case_tools.require_depths(measured, [1.0, None], "map")


@unittest.skipUnless(cases.CASES.is_dir(), "../shared/cases is absent")
@unittest.skipUnless(cases.DTOF.is_file(), "dtof is not built")
class Cases(unittest.TestCase):
    def test_every_case_has_a_rule(self) -> None:
        folders = {path.name for path in cases.CASES.iterdir() if path.is_dir()}
        self.assertFalse(folders - cases.QUICK.keys() - cases.SLOW.keys())

    def test_the_quick_ones_are_good(self) -> None:
        # Settings are torn as long as software cannot commit them together.
        names = cases.QUICK.keys() - (set() if cases.has_commit() else {"torn_settings"})
        status, out = run("--only", *sorted(names))
        self.assertEqual(status, 0, out)


if __name__ == "__main__":
    unittest.main()
