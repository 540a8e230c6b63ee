# SPDX-License-Identifier: Apache-2.0
"""Read-outs and their parameters are those of readouts.toml."""

import tomllib
import unittest
from typing import Any

import numpy as np

import dtof

from programs import ROOT

KNOWN = tomllib.loads((ROOT / "readouts.toml").read_text(encoding="utf-8"))["readout"]


class ReadoutTest(unittest.TestCase):
    def test_every_readout_has_its_choices(self) -> None:
        self.assertEqual(list(dtof.readouts()), list(KNOWN))
        for name, described in KNOWN.items():
            readout = dtof.Readout(name)
            self.assertEqual((readout.name, readout.title, readout.summary), (name, described["title"], described["summary"]))
            self.assertEqual(set(readout.parameters), {"np", "slots", *(choice.lower() for choice in described["choices"])})
            self.assertEqual(readout.pools_pixels, described["kind"] == "pool")

    def test_every_choice_is_a_keyword(self) -> None:
        for name in KNOWN:
            for parameter, value in dtof.Readout(name).parameters.items():
                if parameter == "np" or (KNOWN[name]["kind"] == "pool" and parameter == "count_width"):
                    continue  # others follow from the one, the other has one value
                if parameter in ("group_size", "engine_columns"):
                    other = 2 * value
                else:
                    other = 1 - value if parameter == "window_centred" else value - 1 if value > 2 else value + 1
                changed: dict[str, Any] = {parameter: other}
                self.assertEqual(dtof.Readout(name, **changed).parameters[parameter], other, f"{name} {parameter}")
                self.assertNotEqual(dtof.Readout(name, **changed), dtof.Readout(name))

    def test_defaults_follow_from_np_and_the_sensor(self) -> None:
        self.assertEqual(dtof.Readout("sifh", np=12).parameters["nb"], 7)
        self.assertEqual(dtof.Readout("hispointer", dtof.Sensor("thesis").replace(np=11)).parameters["guard"], 92)

    def test_wrong_names_and_values(self) -> None:
        cases: list[tuple[tuple[str], dict[str, Any], str]] = [
                (("sifj",), {}, "unknown read-out 'sifj'; did you mean 'sifh'?"),
                (("sifh",), {"guard": 3}, "sifh has no parameter "),
                (("sifh",), {"nb": 40}, "NB must be 1 to NP, not 40"),
                (("sifh",), {"nb": 4.5}, "nb: 4.5 is no whole number"),
                (("sifh",), {"nb": "4"}, "nb: '4' is no whole number"),
                (("sifh",), {"nb": 1 << 40}, "nb: 1099511627776 is no whole number of 32 bits"),
                (("sifh",), {"window_centred": 2}, "WINDOW_CENTRED must be 0 or 1, is 2")]
        for arguments, keywords, sentence in cases:
            with self.subTest(sentence), self.assertRaises(ValueError) as raised:
                dtof.Readout(*arguments, **keywords)
            self.assertTrue(str(raised.exception).startswith(sentence), str(raised.exception))
            self.assertNotIn("\n", str(raised.exception))

    def test_template(self) -> None:
        sensor = dtof.Sensor("thesis+glass").replace(acquisitions=1000)
        compensated = dtof.Readout("poolpointer", sensor, template=True)
        self.assertEqual(len(compensated.template), 32)
        self.assertGreater(max(compensated.template), 0)
        self.assertEqual(dtof.Readout("poolpointer", sensor).template, [0] * 32)
        self.assertEqual(dtof.Readout("poolpointer", sensor, template=compensated.template), compensated)
        # A dark frame whose only light is the glass's: the entries are those of the sensor, but for the noise of other photons.
        dark = dtof.photons(dtof.Scene.from_depth(np.full((160, 8), 5.0), reflectivity=1e-9), sensor, klux=0.0, seed=5)
        own = dtof.Readout("poolpointer", sensor, template=dark)
        self.assertNotEqual(own.template, [0] * 32)
        np.testing.assert_allclose(own.template, compensated.template, rtol=0.1, atol=4)

    def test_templates_that_are_refused(self) -> None:
        dark = dtof.event_list([], [], [], [], columns=2, rows=1, acquisitions=100)
        cases: list[tuple[str, str, bool | dtof.Photons | list[int], str]] = [
                ("sifh", "thesis+fog", True, "template has no effect: sifh has no TEMPLATE"),
                ("poolpointer", "thesis", True, "template has no effect: the sensor has neither cover glass nor fog"),
                ("poolpointer", "thesis", [1] * 31, "template: needs 32 entries, not 31"),
                ("poolpointer", "thesis", [256] * 32, "template: entries are 0 to 255, not 256"),
                ("poolpointer", "thesis", dark, "a template needs a column of at least two rows")]
        for name, sensor, template, sentence in cases:
            with self.subTest(sentence), self.assertRaises(ValueError) as raised:
                dtof.Readout(name, dtof.Sensor(sensor), template=template)
            self.assertEqual(str(raised.exception), sentence)

    def test_frames_refuse_readouts_of_different_timestamps(self) -> None:
        with self.assertRaisesRegex(ValueError, "NP and SLOTS must be the same"):
            dtof.frame(readouts=[dtof.Readout("sifh", np=9), "fifh"])
        with self.assertRaisesRegex(ValueError, "sifh is named twice"):
            dtof.frame(readouts=["sifh", dtof.Readout("sifh", nb=3)])

    def test_table_is_the_frames(self) -> None:
        frame = dtof.frame(dtof.Scene("room", columns=5, rows=4), "phone", ["sifh"], klux=30.0, seed=9)
        table = frame["sifh"].table
        assert table is not None
        alone = dtof.LookupTable.flat("sifh", dtof.Sensor("phone"), 30.0, seed=9)
        np.testing.assert_array_equal(alone.knots, table.knots)
        results = frame["sifh"].results
        np.testing.assert_array_equal(results.distance_m(dtof.Sensor("phone"), alone), frame["sifh"].depth_m)
        np.testing.assert_array_equal(np.maximum(alone.distance(results.position), 0.0).astype(np.float32)[results.has_distance],
                                      frame["sifh"].depth_m[results.has_distance])

    def test_table_of_own_measurements(self) -> None:
        distances = np.linspace(1.0, 4.0, 7)
        table = dtof.LookupTable.fit([float(distance) for distance in distances], np.outer(distances, np.full(9, 100.0)), 0.0)
        np.testing.assert_allclose(table.distance([150.0, 333.0]), [1.5, 3.33])
        with self.assertRaisesRegex(ValueError, "needs two axes"):
            dtof.LookupTable.fit([1.0, 2.0], np.zeros(2))

    def test_depth_is_equation_3_11(self) -> None:
        resolution = 45e-9 / 1024
        self.assertAlmostEqual(float(dtof.depth(100.0, pulse_fwhm_s=2e-9)), 299_792_458 / 2 * (100.5 * resolution - 2e-9), 12)


if __name__ == "__main__":
    unittest.main()
