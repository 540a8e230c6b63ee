# SPDX-License-Identifier: Apache-2.0
"""Pulses of other widths: sensors differ in the pulse alone, and the figures are those of the table."""

import tempfile
import tomllib
import unittest
from pathlib import Path

import pulse_widths

HEADER = "sensor,klux,scene,estimator,pixels,above_3_percent,above_10_percent,relative_bound,median_error_over_bound"
ROWS = ("fwhm8,14,flat 3 m,hisPointer,1600,0.9,0.9,0.002,1.5", "fwhm8,14,room,hisPointer,100,0.1,0.02,0.001,9",
        "fwhm8,14,poles,hisPointer,300,0.3,0.06,0.001,9", "fwhm45,14,room,hisPointer,100,0.5,0.25,0.001,9")


class PulseWidths(unittest.TestCase):
    def test_sensors_differ_in_the_pulse_alone(self) -> None:
        preset = pulse_widths.PRESET.read_text(encoding="utf-8")
        thesis = tomllib.loads(preset)
        sensor = tomllib.loads(pulse_widths.sensor_of(8, preset))
        self.assertEqual(sensor.pop("name"), "fwhm8")
        self.assertAlmostEqual(sensor["laser"].pop("pulse_fwhm_ns"), 8 * 45 / 1024)
        thesis.pop("name")
        thesis["laser"].pop("pulse_fwhm_ns")
        self.assertEqual(sensor, thesis)

    def test_read_outs_that_follow_the_pulse_have_rows_of_their_own(self) -> None:
        short = {"poolPointer", "poolPointer CELL_SHIFT=9", "poolPointer lean", "poolPointer lean CELL_SHIFT=9"}
        self.assertEqual(pulse_widths.rows_of("poolPointer", short), ["poolPointer"])
        self.assertEqual(pulse_widths.rows_of("poolPointer CELL_SHIFT=9", short), ["poolPointer" + pulse_widths.FIXED])
        self.assertEqual(pulse_widths.rows_of("poolPointer lean", short), ["poolPointer lean"])
        # Where the pulse asks for them, both are the same.
        self.assertEqual(pulse_widths.rows_of("poolPointer", {"poolPointer", "poolPointer lean CELL_SHIFT=9"}),
                         ["poolPointer", "poolPointer" + pulse_widths.FIXED])
        self.assertEqual(pulse_widths.rows_of("hisPointer", short), ["hisPointer"])

    def test_figures_are_of_all_pixels_but_the_flats(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "scenes.csv"
            path.write_text("\n".join((HEADER, *ROWS)) + "\n", encoding="utf-8")
            figures = pulse_widths.read(path)
        of = figures["14", 8, "hisPointer"]
        self.assertAlmostEqual(of.percent("above_3_percent"), 25)  # 10 of 100 and 90 of 300
        self.assertAlmostEqual(of.percent("above_10_percent"), 5)
        self.assertAlmostEqual(of.sigma, 0.003)
        self.assertAlmostEqual(figures["14", 45, "hisPointer"].percent("above_3_percent"), 50)
        self.assertIn("14,8,hisPointer,0.250000,0.050000,0.003000", pulse_widths.table_csv(figures))


if __name__ == "__main__":
    unittest.main()
