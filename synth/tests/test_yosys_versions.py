# SPDX-License-Identifier: Apache-2.0
"""Results of two versions of Yosys side by side: what counts as a difference, and what has to be explained."""

import json
import tempfile
import unittest
from pathlib import Path

from dtof_synth import configuration, yosys_versions
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
PERIOD_NS = 3.0


def checkout(folder: Path, yosys: str = "0.23", digest: str = "abc", **changed: tuple[float, float, float]) -> Path:
    """A checkout in which make synth ran: ezPointer with 600 um2, 1.3 mm2 and 0.01 ns, unless changed."""
    figures = {"ezpointer": (600.0, 1.3, 0.01), "fifh": (2200.0, 8.7, 0.02)} | changed
    reports = folder / "reports"
    reports.mkdir(parents=True)
    (reports / "digests.json").write_text(json.dumps({"synth": {"digest": digest}}), encoding="utf-8")
    (reports / "area.csv").write_text("configuration,column_um2,total_mm2\n" + "".join(
        f"{name},{column},{array}\n" for name, (column, array, _) in figures.items()), encoding="utf-8")
    (reports / "timing.csv").write_text("configuration,corner,slack_330_ns\n" + "".join(
        f"{name},slow,0.5\n{name},slow with margins,{slack}\n" for name, (_, _, slack) in figures.items()), encoding="utf-8")
    for name in figures:
        run = folder / "build" / "synth" / "runs" / name
        run.mkdir(parents=True)
        (run / "map.log").write_text(f" Yosys {yosys} (git sha1 7ce5011c24b, g++ 12.2.0)\n", encoding="utf-8")
    return folder


class Versions(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.own = yosys_versions.read(checkout(self.folder / "own"))

    def other(self, **changed) -> yosys_versions.Checkout:
        return yosys_versions.read(checkout(self.folder / "other", yosys="0.52", **changed))

    def found(self, **changed) -> list[tuple[str, str]]:
        return [(one.configuration, one.figure) for one in yosys_versions.differences(self.own, self.other(**changed), PERIOD_NS)]

    def test_reads_the_version_and_the_slack_with_margins(self):
        self.assertEqual((self.own.yosys, self.own.figures["ezpointer"].slack), ("0.23", 0.01))

    def test_two_percent_of_each_figure_are_no_difference(self):
        self.assertEqual(self.found(ezpointer=(611.0, 1.325, 0.065)), [])

    def test_more_than_two_percent_are_one_to_either_side(self):
        self.assertEqual(self.found(ezpointer=(613.0, 1.3, 0.01), fifh=(2200.0, 8.5, -0.05)),
                         [("ezpointer", "column"), ("fifh", "array"), ("fifh", "slack")])

    def test_the_share_has_a_sign(self):
        share = yosys_versions.differences(self.own, self.other(ezpointer=(300.0, 1.3, 0.01)), PERIOD_NS)[0].share
        self.assertAlmostEqual(share, -0.5)

    def test_other_inputs_cannot_be_compared(self):
        with self.assertRaisesRegex(FlowError, "ran on other inputs in the other checkout: def, here abc"):
            self.found(digest="def")

    def test_other_configurations_cannot_be_compared(self):
        with self.assertRaisesRegex(FlowError, "not the same configurations in both checkouts: sifh"):
            self.found(sifh=(2300.0, 15.0, 0.0))

    def test_a_checkout_without_results_is_named(self):
        with self.assertRaisesRegex(FlowError, r"nothing/reports/digests.json: cannot read the digests"):
            yosys_versions.read(self.folder / "nothing")

    def test_netlists_of_two_versions_in_one_checkout_are_refused(self):
        folder = checkout(self.folder / "mixed")
        (folder / "build" / "synth" / "runs" / "fifh" / "map.log").write_text("Yosys 0.52\n", encoding="utf-8")
        with self.assertRaisesRegex(FlowError, "logs of several versions of Yosys: 0.23, 0.52"):
            yosys_versions.read(folder)


class Explanations(unittest.TestCase):
    FOUND = [yosys_versions.Difference("fifh", "slack", -0.03)]

    def test_a_difference_without_a_reason_is_open(self):
        self.assertEqual(yosys_versions.open_points(self.FOUND, {}), ["fifh: slack differs by -3.0% and has no explanation"])

    def test_a_reason_without_a_difference_is_open(self):
        reasons = {("fifh", "slack"): "ABC.", ("fifh", "array"): "Nothing."}
        self.assertEqual(yosys_versions.open_points(self.FOUND, reasons), ["fifh: array has an explanation but no difference"])

    def test_the_projects_explanations_can_be_read(self):
        named = configuration.load(ROOT / "configurations.toml")
        for name, figure in yosys_versions.explanations(ROOT / yosys_versions.EXPLANATIONS):
            self.assertIn(name, named)
            self.assertIn(figure, yosys_versions.FIGURES)


class Page(unittest.TestCase):
    def page(self, slack: float, reasons: dict) -> str:
        named = configuration.load(ROOT / "configurations.toml")
        own = yosys_versions.Checkout("0.23", "abc", {"fifh": yosys_versions.Figures(2200.0, 8.7, 0.02)})
        other = yosys_versions.Checkout("0.52", "abc", {"fifh": yosys_versions.Figures(2211.0, 8.787, slack)})
        return yosys_versions.report(own, other, named, yosys_versions.differences(own, other, PERIOD_NS), reasons)

    def test_the_answer_stands_first(self):
        self.assertIn("differ by at most 1.0% in the area of an array. Every configuration closes with margins with both.", self.page(0.01, {}))
        self.assertIn("Not closed with margins with Yosys 0.52: FiFH.", self.page(-0.001, {}))

    def test_the_row_has_both_versions(self):
        self.assertIn("| FiFH | 2200 | 2211 | 8.700 | 8.787 | +0.020 | +0.010 |", self.page(0.01, {}))

    def test_a_difference_stands_with_its_reason_or_says_that_it_has_none(self):
        self.assertIn("* FiFH, slack: -4.0%. **No explanation.**", self.page(-0.1, {}))
        self.assertIn("* FiFH, slack: -4.0%. ABC.", self.page(-0.1, {("fifh", "slack"): "ABC."}))
