# SPDX-License-Identifier: Apache-2.0
"""Figures and intervals, against NumPy and by drawing samples."""

import unittest

import numpy as np

import dtof


class MetricsTest(unittest.TestCase):
    def test_error_summary_is_numpys(self) -> None:
        random = np.random.default_rng(3)
        truth = random.uniform(1.0, 5.0, (8, 9))
        measured = truth + random.normal(0.01, 0.05, truth.shape)
        truth[0, 0] = measured[3, 4] = np.nan
        summary = dtof.error_summary(truth, measured)
        known = ~np.isnan(truth) & ~np.isnan(measured)
        error = (measured - truth)[known]
        relative = np.abs(error) / truth[known]
        self.assertEqual(summary.count, 70)
        for value, wanted in [(summary.bias_m, error.mean()), (summary.rmse_m, np.sqrt((error**2).mean())),
                              (summary.standard_deviation_m, error.std(ddof=1)), (summary.relative_precision, relative.std(ddof=1)),
                              (summary.share_above_3_percent, (relative > 0.03).mean()),
                              (summary.share_above_10_percent, (relative > 0.1).mean())]:
            self.assertAlmostEqual(value, float(wanted), 12)
        with self.assertRaisesRegex(ValueError, "3 true and 2 measured"):
            dtof.error_summary([1.0, 1.0, 1.0], [1.0, 1.0])

    def test_a_frames_figures_are_those_of_its_maps(self) -> None:
        frame = dtof.frame(dtof.Scene("room", columns=20, rows=20), readouts=["histogram"])
        made = frame["histogram"]
        self.assertEqual(made.figures["share_without_distance"], 0.0)  # else the maps do not have all errors
        summary = dtof.error_summary(frame.truth_m, frame.truth_m + made.error_m)
        self.assertEqual(summary.count, made.figures["pixels"])
        self.assertAlmostEqual(summary.rmse_m, made.figures["rmse_m"], 6)
        self.assertAlmostEqual(summary.bias_m, made.figures["bias_m"], 6)

    def test_intervals_hold_the_truth_as_often_as_they_say(self) -> None:
        random = np.random.default_rng(11)
        held = {"mean": 0, "deviation": 0, "share": 0}
        rounds = 400
        for _ in range(rounds):
            values = random.normal(2.0, 3.0, 40)
            for name, estimate, truth in [("mean", dtof.estimate_mean(values), 2.0),
                                          ("deviation", dtof.estimate_standard_deviation(values), 3.0),
                                          ("share", dtof.estimate_share(int(random.binomial(200, 0.03)), 200), 0.03)]:
                low, high = estimate.interval
                held[name] += low <= truth <= high
        for name, count in held.items():
            self.assertGreater(count / rounds, 0.90, name)
        self.assertLess(held["mean"] / rounds, 0.985)

    def test_estimates(self) -> None:
        estimate = dtof.estimate_root_mean_square([3.0, -4.0, 5.0])
        self.assertAlmostEqual(float(estimate), np.sqrt(50 / 3))
        self.assertLess(estimate.interval[0], estimate.value)
        rare = dtof.estimate_share(0, 100)
        self.assertEqual((rare.value, rare.interval[0]), (0.0, 0.0))
        self.assertAlmostEqual(rare.interval[1], 1 - 0.025 ** (1 / 100), 9)  # Clopper and Pearson
        frames = dtof.estimate_share_of_frames([0.1, 0.2, 0.3], 1000)
        self.assertAlmostEqual(frames.value, 0.2)
        self.assertGreater(frames.interval[1] - frames.interval[0], 0.2)  # frames differ by more than pixels would
        errors = dtof.target_errors(2.0, 2.0 + np.linspace(-0.101, 0.101, 51), (0.0, 6.75))
        self.assertAlmostEqual(errors["bias_m"].value, 0.0, 12)
        self.assertAlmostEqual(errors["rmse_m"].value, float(np.sqrt((np.linspace(-0.101, 0.101, 51)**2).mean())), 12)
        self.assertAlmostEqual(errors["share_above_3_percent"].value, 22 / 51, 12)
        with self.assertRaises(ValueError):
            dtof.estimate_mean([1.0])
        with self.assertRaises(ValueError):
            dtof.estimate_mean([1.0, np.nan])


if __name__ == "__main__":
    unittest.main()
