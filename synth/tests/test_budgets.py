# SPDX-License-Identifier: Apache-2.0
"""Budgets: what counts as moved, to either side."""

import tempfile
import unittest
from dataclasses import replace
from pathlib import Path
from unittest import mock

from dtof_synth import budgets, configuration
from dtof_synth.errors import FlowError
from dtof_synth.power import Power
from dtof_synth.run import Result

from .partial import part_of
from .small_results import ROOT, TIMING, result

BUDGET = {"logic_column_um2": 500.0, "shared_um2": 20000.0, "sram_column_um2": 0.0, "total_mm2": 1.0, "power_mw": 200.0,
          "fmax_slow_mhz": 400.0, "fmax_typical_mhz": 1000.0}


class Budgets(unittest.TestCase):
    def moved(self, **changed: float) -> list[str]:
        with mock.patch.object(budgets, "figures", lambda _: BUDGET | changed):
            return budgets.moved({"some": BUDGET}, {"some": part_of(Result)})

    def test_every_figure_has_two_per_cent_to_both_sides(self) -> None:
        for figure, budget in BUDGET.items():
            if not budget:
                continue
            for factor, said in ((1.019, ""), (0.981, ""), (1.021, "+2.1%"), (0.979, "-2.1%")):
                lines = [f"some: {figure} {budget:g} -> {factor * budget:g} ({said})"] if said else []
                self.assertEqual(self.moved(**{figure: factor * budget}), lines)

    def test_the_figures_are_those_of_the_result(self) -> None:
        # 200 columns of 500 um2 and 20,000 um2 beside them are 0.12 mm2 without the SRAMs.
        some = result("ezpointer", 500.0, 20000.0)
        found = budgets.figures(some)
        self.assertEqual(list(found), list(BUDGET))
        self.assertEqual(list(found), list(budgets.FIGURES))
        self.assertAlmostEqual(found["total_mm2"], 0.12 + 200e-6 * some.sram_area, delta=1e-4)
        self.assertEqual([found[name] for name in ("logic_column_um2", "shared_um2", "power_mw", "fmax_slow_mhz", "fmax_typical_mhz")],
                         [500.0, 20000.0, 6.0, 400.0, 400.0])

    def test_figures_are_rounded_to_what_a_reader_compares(self) -> None:
        timing = replace(TIMING, fmax_mhz=412.345)
        some = replace(result("ezpointer", 500.06, 20000.04), timing={"slow": timing, "typical": replace(timing, fmax_mhz=987.654)},
                       power=Power(1.04, 2.04, 3.04))
        found = budgets.figures(some)
        self.assertEqual([found[name] for name in ("logic_column_um2", "shared_um2", "power_mw", "fmax_slow_mhz", "fmax_typical_mhz")],
                         [500.1, 20000.0, 6.1, 412.3, 987.7])
        self.assertEqual((found["sram_column_um2"], found["total_mm2"]), (round(some.sram_area, 1), round(some.total_mm2, 4)))
        self.assertEqual(budgets.figures(replace(some, power=None))["power_mw"], 0.0)

    def test_what_is_written_is_read(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "budgets.csv"
            self.assertEqual(budgets.read(path), {})
            some = {name: result(name) for name in ("ezpointer", "sifh")}
            budgets.write(path, some)
            self.assertEqual(budgets.read(path), {name: budgets.figures(one) for name, one in some.items()})

    def test_a_figure_that_was_nothing_and_is_something_has_moved(self) -> None:
        self.assertEqual(self.moved(sram_column_um2=3.0), ["some: sram_column_um2 0 -> 3 (+100.0%)"])

    def test_lists_that_differ(self) -> None:
        self.assertEqual(budgets.moved({"gone": BUDGET}, {"new": part_of(Result)}),
                         ["new: no budget yet", "gone: has a budget but is no configuration"])

    def test_the_committed_file_has_every_figure_of_every_configuration(self) -> None:
        found = budgets.read(ROOT / "synth" / "budgets.csv")
        self.assertEqual(list(found), list(configuration.load(ROOT / "configurations.toml")))
        for budget in found.values():
            self.assertTrue(all(value > 0 for value in budget.values()))
        with tempfile.TemporaryDirectory() as folder:
            old = Path(folder) / "budgets.csv"
            old.write_text("configuration,total_mm2\nsome,1.0\n", encoding="utf-8")
            with self.assertRaisesRegex(FlowError, "not a budget file"):
                budgets.read(old)


if __name__ == "__main__":
    unittest.main()
