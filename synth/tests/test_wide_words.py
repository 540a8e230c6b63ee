# SPDX-License-Identifier: Apache-2.0
"""Read energy of words wider than the points of the SRAM model."""

import re
import unittest
from pathlib import Path

from dtof_synth import sram_model, wide_words
from dtof_synth.errors import found_in

MACROS = Path(__file__).resolve().parents[3] / "shared" / "pdk" / "fakeram45"


class WideWords(unittest.TestCase):
    def test_a_series_is_met_at_its_points_and_between_them(self):
        series = {64: 2.0, 128: 8.0, 256: 16.0}  # exponents 2 and 1
        for bits, energy in {64: 2.0, 96: 2.0 * 1.5**2, 128: 8.0, 192: 12.0, 256: 16.0, 512: 32.0}.items():
            self.assertAlmostEqual(wide_words.growth(series, bits), energy / 2.0)

    def test_the_factor_is_between_the_series_and_begins_behind_the_points(self):
        self.assertEqual([wide_words.read_factor(bits) for bits in (8, 64)], [1.0, 1.0])
        for bits in (65, 128, 232):
            ratios = [wide_words.growth(series, bits) / wide_words.model_growth(bits) for series in wide_words.MACROS.values()]
            self.assertLess(min(ratios), wide_words.read_factor(bits))
            self.assertLess(wide_words.read_factor(bits), max(ratios))

    def test_factors_by_hand(self):
        # Series: 1.1954 and 1.5421 at 96 bits, 2.1986 and 2.0713 at 124, 4.8035 and 4.9542 at 232. Model: (bits + 3.6932) / 67.6932.
        for bits, factor in ((96, 0.92943), (124, 1.13178), (232, 1.40125)):
            self.assertAlmostEqual(wide_words.read_factor(bits), factor, delta=2e-4)

    def test_the_table_has_every_point_beyond_those_fitted(self):
        rows = [line for line in wide_words.lines() if re.match(r"\| \d", line)]
        self.assertEqual(rows, ["| 64 x 96 | 1.20 | 1.47 | 1.23 |", "| 64 x 124 | 2.20 | 1.89 | 0.86 |", "| 64 x 256 | 5.43 | 3.84 | 0.71 |",
                                "| 128 x 116 | 1.89 | 1.77 | 0.94 |", "| 128 x 256 | 5.68 | 3.84 | 0.68 |"])

    def test_the_model_grows_as_its_macros_do(self):
        narrow, wide = (sram_model.macro(sram_model.Size(1, 160, bits)) for bits in (64, 128))
        self.assertEqual(narrow.rows, wide.rows)
        self.assertAlmostEqual(wide.read_energy / narrow.read_energy, wide_words.model_growth(128))

    @unittest.skipUnless(MACROS.is_dir(), "../shared/pdk is not present")
    def test_the_energies_are_of_the_same_generator(self):
        """The macros that are here have to lie on either side of those that are written down."""
        def energy(name: str) -> float:
            text = (MACROS / f"fakeram45_{name}.lib").read_text(encoding="ascii")
            return float(found_in("the generator of macros", r"pin\(clk\)[\s\S]*?values \(\"([\d.]+)", text)[1])

        for words in (64, 128):
            self.assertLess(energy(f"{words}x32"), wide_words.MACROS[words][64])
            self.assertLess(wide_words.MACROS[words][64], energy("512x64"))


if __name__ == "__main__":
    unittest.main()
