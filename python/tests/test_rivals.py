# SPDX-License-Identifier: Apache-2.0
"""Rivals are those of the study, share for share; families take numbers."""

import csv
import tempfile
import unittest
from pathlib import Path

import numpy as np

import dtof

import programs

STUDIED = ["histogram32", "hedh4", "gray8", "guided"]  # guided takes three frames


class RivalTest(unittest.TestCase):
    def test_shares_are_the_studys(self) -> None:
        columns = 40
        with tempfile.TemporaryDirectory() as folder:
            programs.run("dtof-study", "rivals", "--scene", "room", "--rival", *STUDIED, "--readout", "sifh", "--klux", 14,
                         "--columns", columns, "--seeds", 1, "--out", folder)
            with open(Path(folder) / "rivals.csv", encoding="utf-8", newline="") as stream:
                expected = {line["estimator"]: line for line in csv.DictReader(stream) if line["scene"] == "room"}
        sensor = dtof.Sensor("thesis")
        scene = dtof.Scene("room", sensor)
        picked = [(2 * i + 1) * scene.columns // (2 * columns) for i in range(columns)]
        truth = scene.depth_m[:, picked]
        frames = [dtof.photons(scene, sensor, frame=number) for number in (3, 1, 0)]  # the study's, the oldest first
        for name in STUDIED:
            rival = dtof.Rival(name, sensor)
            made = rival.read_out(frames[-rival.frames:])
            measured = rival.flat_table().distance(made["position"][:, picked])
            line = expected[rival.title]
            self.assertEqual(int(line["pixels"]), truth.size)
            self.assertEqual(float(line["bits_per_pixel"]), rival.bits_per_pixel)
            error = np.abs(measured - truth) / truth
            for share, limit in [("above_3_percent", 0.03), ("above_10_percent", 0.1)]:
                self.assertAlmostEqual(float(np.mean(error > limit)), float(line[share]), 5, f"{name} {share}")

    def test_every_rival_reads(self) -> None:
        scene = dtof.Scene("flat", columns=3, rows=2, distance_m=2.0)
        sensor = dtof.Sensor("thesis")
        photons = [dtof.photons(scene, sensor, klux=2.0, frame=frame) for frame in (2, 1, 0)]
        for name in dtof.rivals():
            rival = dtof.Rival(name)
            self.assertGreater(len(rival.citation), 10)
            made = rival.read_out(photons[-rival.frames:])
            self.assertEqual((made["position"].shape, made["position"].dtype), ((2, 3), np.float64))
            self.assertEqual((made["words"].shape[:2], made["words"].dtype), ((2, 3), np.int32))

    def test_a_family_with_the_lists_numbers_is_the_listed_rival(self) -> None:
        photons = dtof.photons(dtof.Scene("room", columns=4, rows=4), dtof.Sensor("thesis"))
        families: list[tuple[str, str, dict[str, int]]] = [
            ("histogram32", "histogram", {"bin_bits": 5}), ("hedh16", "hedh", {"parts": 16}),
            ("pedh8-optimised", "pedh", {"parts": 8, "optimised": 1}), ("fourier16-2bit", "fourier", {"counters": 16, "bits": 2}),
            ("gray8", "gray", {"counters": 8}), ("sketch4", "sketch", {"size": 4}),
            ("spline16", "spline", {"knots": 16, "count_bits": 11}), ("legendre16", "legendre", {"order": 16}), ("correlations-slow", "correlations", {"shift": 12}),
            ("guided", "guided", {"count_bits": 10})]
        for name, family, numbers in families:
            listed, own = dtof.Rival(name), dtof.Rival(family, None, **numbers)
            self.assertEqual(own.bits_per_pixel, listed.bits_per_pixel, name)
            self.assertLessEqual(numbers.items(), own.parameters.items())
            read = [photons] * listed.frames
            np.testing.assert_array_equal(own.read_out(read)["words"], listed.read_out(read)["words"], err_msg=name)
        self.assertNotEqual(dtof.Rival("hedh", parts=8).bits_per_pixel, dtof.Rival("hedh", parts=16).bits_per_pixel)

    def test_refusals(self) -> None:
        photons = dtof.photons(dtof.Scene("flat", columns=1, rows=1), dtof.Sensor("thesis"))
        for call, sentence in [(lambda: dtof.Rival("hedg4"), "no rival is called hedg4; known are histogram32"),
                               (lambda: dtof.Rival("hedh4", parts=8), "rival hedh4 has no parameters"),
                               (lambda: dtof.Rival("hedh", bits=8), "rival hedh has no parameter bits; it has parts"),
                               (lambda: dtof.Rival("hedh", parts=65), "rival hedh: parts must be 2 to 64, is 65"),
                               (lambda: dtof.Rival("hedh", parts=6), "equi-depth: 6 parts, but it must be a power of two"),
                               (lambda: dtof.Rival("hedh", parts=4.5), "parts: 4.5 is no whole number"),  # type: ignore[arg-type]
                               (lambda: dtof.Rival("guided").read_out(photons), "rival guided needs 3 frames, the oldest first; these are 1")]:
            with self.subTest(sentence), self.assertRaises(ValueError) as raised:
                call()
            self.assertTrue(str(raised.exception).startswith(sentence), str(raised.exception))


if __name__ == "__main__":
    unittest.main()
