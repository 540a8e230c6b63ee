# SPDX-License-Identifier: Apache-2.0
"""One naming for `make synth`; the spread over several is a report of its own."""

import tempfile
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import batch, configuration, namings, run
from dtof_synth.technology import Technology

from .partial import part_of

ROOT = Path(__file__).resolve().parents[2]


def result(mm2: float, setup: float = 0.01, hold: float = 0.0) -> run.Result:
    return part_of(run.Result, total_mm2=mm2, margins={"slow": part_of(run.Margin, slack=setup), "fast": part_of(run.Margin, hold_slack=hold)})


class Efforts(unittest.TestCase):
    def efforts_tried(self, closing: set, most: int | None = None, name: str = "hispointer", naming: int = 0) -> list:
        """(effort, naming) of each mapping, where the efforts in `closing` close."""
        tried = []

        def attempt(_configuration, _technology, _folder, number, naming):
            tried.append((number, naming))
            return part_of(run._Attempt, closes_with_margins=number in closing)

        with mock.patch.object(run, "_attempt", attempt):
            run._attempts(configuration.load(ROOT / "configurations.toml")[name], part_of(Technology), Path(), most, naming)
        return tried

    def test_efforts_are_tried_until_one_closes(self) -> None:
        for name in ("ezpointer", "poolpointer"):
            self.assertEqual(self.efforts_tried({0}, name=name), [(0, 0)])
            self.assertEqual(self.efforts_tried({1}, name=name), [(0, 0), (1, 0)])

    def test_every_effort_has_the_naming_that_was_asked_for(self) -> None:
        self.assertEqual(self.efforts_tried({1}, naming=5), [(0, 5), (1, 5)])

    def test_the_first_effort_stands_where_timing_need_not_close(self) -> None:
        self.assertEqual(self.efforts_tried(set(), most=1), [(0, 0)])

    def test_the_smallest_that_closes_is_taken_else_the_one_that_misses_least(self) -> None:
        def attempt(area: float, rank: float) -> run._Attempt:
            return part_of(run._Attempt, rank=rank, closes_with_margins=rank >= 0, overloaded=0, netlist=part_of(run._Netlist, cell_area=lambda: area))

        self.assertEqual(run._best([attempt(3, 0.2), attempt(2, 0.0), attempt(1, -0.1)]).netlist.cell_area(), 2)
        self.assertEqual(run._best([attempt(3, -0.1), attempt(2, -0.2)]).netlist.cell_area(), 3)


class Spread(unittest.TestCase):
    def setUp(self) -> None:
        self.configuration = configuration.load(ROOT / "configurations.toml")["ezpointer"]
        self.jobs = namings.jobs([self.configuration])

    def spread(self, **changed: run.Result) -> namings.Spread:
        """Areas 1.00, 1.01 ... 1.07 mm2, all closing, but for the `changed` jobs."""
        results = {job.name: result(1 + job.naming / 100) for job in self.jobs} | changed
        return namings.spreads([self.configuration], results)["ezpointer"]

    def test_each_naming_is_a_job_with_a_folder_of_its_own(self) -> None:
        self.assertEqual([job.naming for job in self.jobs], list(range(8)))
        self.assertEqual(len({job.name for job in self.jobs}), 8)
        self.assertEqual(self.jobs[0].name, batch.Job(self.configuration).name)

    def test_results_of_two_namings_have_different_keys(self) -> None:
        self.assertEqual(len({batch._key(job, "digest") for job in self.jobs}), 8)

    def test_the_quoted_area_is_the_first_naming_and_not_the_smallest(self) -> None:
        spread = self.spread(ezpointer=result(1.2))
        self.assertEqual(spread.quoted, 1.2)
        self.assertAlmostEqual(spread.median, 1.045)
        self.assertAlmostEqual(spread.spread, 0.19 / 1.045)

    def test_one_naming_that_misses_is_a_read_out_that_does_not_close(self) -> None:
        self.assertTrue(self.spread().closes)
        for missing in (result(1, setup=-0.001), result(1, hold=-0.001)):
            spread = self.spread(ezpointer_naming3=missing)
            self.assertEqual((spread.closes, spread.closing), (False, 7))
            self.assertIn("Not closed with every naming: ezPointer.", namings.report({"ezpointer": spread}, "0" * 64))

    def test_the_table_has_the_worst_slacks(self) -> None:
        spread = self.spread(ezpointer_naming2=result(1.02, setup=0.002), ezpointer_naming4=result(1.04, hold=-0.0003))
        self.assertIn("| +0.0020 | -0.0003 | 7 of 8 |", namings.table({"ezpointer": spread}))

    def test_the_csv_has_a_line_for_each_configuration(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            namings.write_csv(Path(folder) / "namings.csv", {"ezpointer": self.spread()})
            lines = (Path(folder) / "namings.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(lines[1], "ezpointer,1.0000,1.0350,1.0000,1.0700,0.0100,0.0000,8,8")


if __name__ == "__main__":
    unittest.main()
