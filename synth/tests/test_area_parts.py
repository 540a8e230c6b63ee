# SPDX-License-Identifier: Apache-2.0
import unittest
from pathlib import Path
from unittest import mock

from dtof_synth import area_parts, configuration, library, report, sram_model, wide_words
from dtof_synth.netlist import Counts
from dtof_synth.power import ClockTree
from dtof_synth.run import Result
from dtof_synth.sram_model import Size

ROOT = Path(__file__).resolve().parents[2]
NANGATE = ROOT.parent / "shared" / "pdk" / "liberty" / "nangate45_typ.lib.gz"
COLUMN = Counts(2000, 150, 2400.0, 10, 20.0, 0.0, 0.0)
SHARED = Counts(900, 300, 9000.0, 100, 500.0, 0.0, 0.0)
ENGINES = Counts(600, 200, 6000.0, 30, 120.0, 0.0, 0.0)
NONE = Counts(0, 0, 0.0, 0, 0.0, 0.0, 0.0)


def result(name: str, engines: Counts) -> Result:
    chosen = configuration.load(ROOT / "configurations.toml")[name]
    return Result(chosen, COLUMN, SHARED, engines, ClockTree(100, 300.0, 0.0), 0.8, 2.0, {})


class Parts(unittest.TestCase):
    def test_they_sum_to_the_total(self):
        for name, engines in (("ezpointer", NONE), ("hispointer", NONE), ("poolpointer", ENGINES)):
            one = result(name, engines)
            self.assertAlmostEqual(area_parts.parts(one).total, one.total_mm2 * 1e6, places=3)

    def test_each_part(self):
        parts = area_parts.parts(result("poolpointer", ENGINES))
        self.assertAlmostEqual(parts.column_logic, 50 * 2400.0)  # a column module has four columns
        self.assertAlmostEqual(parts.column_sram, 50 * sram_model.macro(Size(1, 100, 232, 8)).area)
        self.assertAlmostEqual(parts.engines, 6000.0 - 120.0)
        self.assertAlmostEqual(parts.scratch_sram, 6 * sram_model.macro(Size(1, 160, 33)).area)
        self.assertAlmostEqual(parts.control, 9000.0 - 500.0 - 5880.0)
        self.assertAlmostEqual(parts.fan_out, 500.0)

    def test_placed_by_hand(self):
        one = result("ezpointer", NONE)
        macro = sram_model.macro(Size(2, 160, 14))
        cells = 200 * 2400.0 + 9000.0
        halo = 200 * (macro.width + 4.0) * (macro.height + 4.0)
        self.assertAlmostEqual(area_parts.placed(one), cells / 0.75 + halo, places=3)
        self.assertEqual(area_parts.flip_flops(one), 200 * 150 + 300)
        self.assertAlmostEqual(area_parts.scan(one), 30300 * 2.0)
        self.assertAlmostEqual(area_parts.placed_with_all(one), area_parts.placed(one) + (60600.0 + 300.0) / 0.75,
                               places=3)

    def test_engines_macros_are_placed_too(self):
        one = result("poolpointer", ENGINES)
        halos = 0.0
        for number, size in ((50, Size(1, 100, 232, 8)), (6, Size(1, 160, 33))):
            macro = sram_model.macro(size)
            halos += number * (macro.width + 4.0) * (macro.height + 4.0)
        self.assertAlmostEqual(area_parts.placed(one), (50 * 2400.0 + 9000.0) / 0.75 + halos, places=3)

    def test_wide_words_are_doubtful_with_a_multiplexer_too(self):
        with mock.patch.object(wide_words, "FITTED_BITS", 13):
            self.assertEqual(area_parts.doubtful_macros([result("ezpointer", NONE)]), [Size(2, 160, 14)])

    def test_macros_that_the_points_do_not_cover(self):
        plain, pool = result("ezpointer", NONE), result("poolpointer", ENGINES)
        self.assertEqual(area_parts.doubtful_macros([plain]), [])
        self.assertEqual(area_parts.doubtful_macros([plain, pool]), [Size(1, 100, 232, 8)])
        self.assertAlmostEqual(area_parts.total_with_other_mux(plain), plain.total_mm2 * 1e6, places=3)
        larger = sram_model.macro(Size(1, 100, 232, 8), 2).area - sram_model.macro(Size(1, 100, 232, 8)).area
        self.assertGreater(larger, 1000.0)
        self.assertAlmostEqual(area_parts.total_with_other_mux(pool), pool.total_mm2 * 1e6 + 50 * larger, places=3)


class Report(unittest.TestCase):
    def test_sentences_follow_the_figures(self):
        self.assertIn("No macro lacks", report._doubtful_section([result("ezpointer", NONE)]))
        text = report._doubtful_section([result("ezpointer", NONE), result("poolpointer", ENGINES)])
        self.assertIn("| sram_1rw_100x232_8p | 1 | 11833 | 15219 | yes |", text)
        self.assertRegex(text, r"With a multiplexer of 2: poolPointer [0-9.]+ instead of [0-9.]+ mm2\.")


@unittest.skipUnless(NANGATE.exists(), f"{NANGATE} is not here")
class ScanOfAPublicLibrary(unittest.TestCase):
    def test_a_multiplexer_is_what_a_scan_flip_flop_has_more(self):
        nangate = library.read(NANGATE)
        more = nangate.area["SDFFR_X1"] - nangate.area["DFFR_X1"]
        self.assertLess(abs(nangate.mux2_area / more - 1), 0.45, f"{nangate.mux2_area} against {more}")


if __name__ == "__main__":
    unittest.main()
