# SPDX-License-Identifier: Apache-2.0
"""Budgets: what counts as moved, and as worse."""

import unittest
from unittest import mock

from dtof_synth import budgets

BUDGET = {"logic_column_um2": 500.0, "shared_um2": 20000.0, "sram_column_um2": 0.0, "total_mm2": 1.0, "fmax_slow_mhz": 400.0,
          "fmax_typical_mhz": 1000.0}


class Budgets(unittest.TestCase):
    def moved(self, **changed: float) -> tuple[list[str], bool]:
        with mock.patch.object(budgets, "figures", lambda _: BUDGET | changed):
            return budgets.moved({"some": BUDGET}, {"some": None})

    def test_areas_have_two_per_cent_and_frequencies_ten(self):
        self.assertEqual(self.moved(logic_column_um2=509.0, fmax_slow_mhz=365.0), ([], False))
        self.assertEqual(self.moved(logic_column_um2=511.0), (["some: logic_column_um2 500 -> 511 (+2.2%, worse)"], True))
        self.assertEqual(self.moved(fmax_slow_mhz=358.0), (["some: fmax_slow_mhz 400 -> 358 (-10.5%, worse)"], True))

    def test_what_got_better_is_said_and_is_no_failure(self):
        self.assertEqual(self.moved(total_mm2=0.9), (["some: total_mm2 1 -> 0.9 (-10.0%, better)"], False))
        self.assertEqual(self.moved(fmax_typical_mhz=1150.0), (["some: fmax_typical_mhz 1000 -> 1150 (+15.0%, better)"], False))

    def test_lists_that_differ(self):
        self.assertEqual(budgets.moved({"gone": BUDGET}, {"new": None}),
                         (["new: no budget yet", "gone: has a budget but is no configuration"], False))


if __name__ == "__main__":
    unittest.main()
