// SPDX-License-Identifier: Apache-2.0
#include "app/thesis_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "sensor/preset.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

FigureScene scene(double distance_m, int frames) {
  return {parse_preset("thesis"), 14.0, distance_m, frames, test_seed(), 2};
}

TEST(FullWidthAtHalfMaximum, Triangle) {
  const std::vector<double> curve = {0.0, 1.0, 2.0, 3.0, 4.0, 2.0, 0.0};
  EXPECT_DOUBLE_EQ(full_width_at_half_maximum(curve), 3.0);
}

TEST(FullWidthAtHalfMaximum, Gaussian) {
  constexpr int kPoints = 200;
  std::vector<double> curve;
  curve.reserve(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    curve.push_back(std::exp(-0.5 * std::pow((i - 90.3) / 12.0, 2)));
  }
  EXPECT_NEAR(full_width_at_half_maximum(curve), 12.0 * 2.3548, 0.05);
}

TEST(FullWidthAtHalfMaximum, NeedsBothFlanks) {
  EXPECT_THROW((void)full_width_at_half_maximum(std::vector<double>{3.0, 2.0, 1.0}), std::logic_error);
  EXPECT_THROW((void)full_width_at_half_maximum(std::vector<double>{}), std::logic_error);
}

TEST(PileUp, FarTargetsLoseNothing) {
  SCOPED_TRACE(test_seed_message());
  const PileUp far = pile_up(scene(5.0, 200));
  EXPECT_NEAR(far.lost_share(), 0.0, 0.01);
  EXPECT_NEAR(std::accumulate(far.arriving.begin(), far.arriving.end(), 0.0),
              3333 * (0.3 / 25.0 + 0.15 + 1e4 * 45e-9) * (1023.0 / 1024.0), 0.5);
}

TEST(PileUp, NearTargetsFillBothSlots) {
  SCOPED_TRACE(test_seed_message());
  const PileUp near = pile_up(scene(0.1, 20));  // 30 events per pulse: two are kept
  EXPECT_NEAR(std::accumulate(near.delivered.begin(), near.delivered.end(), 0.0), 2.0 * 3333, 0.01 * 3333);
  EXPECT_EQ(judge_pile_up(near, pile_up(scene(0.5, 20))).verdict, Verdict::kAgrees);
  EXPECT_EQ(judge_pile_up(pile_up(scene(0.5, 20)), near).verdict, Verdict::kDisagrees);
}

TEST(HistogramPeaks, HalfAFrameHasLowerPeaks) {
  SCOPED_TRACE(test_seed_message());
  const HistogramPeaks whole = histogram_peaks(scene(1.0, 100), 3333);
  const HistogramPeaks half = histogram_peaks(scene(1.0, 100), 1666);
  EXPECT_LT(half.count.high, whole.count.low);
  const double target_bin = (2.0 / 0.299792458 + 2.0) / (45.0 / 1024.0);  // 2R/c + FWHM, in bins
  EXPECT_NEAR(whole.bin.median, target_bin + 0.5, 4.0);
  EXPECT_EQ(whole.fake_share, 0.0);
  EXPECT_EQ(judge_peak(half, half.count.median, half.bin.median).verdict, Verdict::kAgrees);
  EXPECT_EQ(judge_peak(half, whole.count.median, half.bin.median).verdict, Verdict::kDisagrees);
  EXPECT_EQ(judge_peak(half, half.count.median, 500.0).verdict, Verdict::kDisagrees);
}

}  // namespace
}  // namespace dtof
