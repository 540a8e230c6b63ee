// SPDX-License-Identifier: Apache-2.0
#include "reproduction/thesis_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "dtof/readout/model.hpp"
#include "dtof/sensor/preset.hpp"
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
  EXPECT_EQ(whole.fake_share.value, 0.0);
  EXPECT_EQ(judge_peak(half, half.count.median, half.bin.median).verdict, Verdict::kAgrees);
  EXPECT_EQ(judge_peak(half, whole.count.median, half.bin.median).verdict, Verdict::kDisagrees);
  EXPECT_EQ(judge_peak(half, half.count.median, 500.0).verdict, Verdict::kDisagrees);
}

TEST(TurnedToPeak, PeakInTheMiddle) {
  EXPECT_EQ(turned_to_peak({0, 9, 1, 2, 3}), (std::vector<double>{3, 0, 9, 1, 2}));
  EXPECT_EQ(turned_to_peak({5, 5, 1}), (std::vector<double>{1, 5, 5}));
}

TEST(SideShares, TurningMakesSidesEqual) {
  SCOPED_TRACE(test_seed_message());
  const SideShares shares = side_shares(scene(1.0, 200));
  // As counted, the background above bin 197 of 1023 is more than that below.
  EXPECT_GT(shares.as_counted.interval.low, 0.55);
  EXPECT_NEAR(shares.turned.value, 0.5, 0.03);
  SideShares turned;
  turned.turned = {0.5, {0.49, 0.51}};
  EXPECT_EQ(judge_sides(turned).verdict, Verdict::kAgrees);
  turned.turned = {0.52, {0.51, 0.53}};
  EXPECT_EQ(judge_sides(turned).verdict, Verdict::kOpen);
  turned.turned = {0.6, {0.59, 0.61}};
  EXPECT_EQ(judge_sides(turned).verdict, Verdict::kDisagrees);
}

// The figure's own histogram has its peak where the read-out's model says.
TEST(FineHistogram, IsThatOfTheReadout) {
  SCOPED_TRACE(test_seed_message());
  const FigureScene place = scene(1.0, 101);
  std::vector<double> bins;
  const IndependentPixels pixels(place.sensor, place.frames);
  const auto source = make_exact_source(place.sensor, pixels.targets({.depth_m = 1.0, .reflectivity = 1.0}),
                                        14.0, place.seed, 0);
  for (int column = 0; column < pixels.columns; ++column) {
    const auto model = make_readout_model(ReadoutParameters::defaults(Readout::kSifh));
    for (const PixelResult& result : model->run_column(source->column(column), place.sensor.acquisitions)) {
      bins.push_back(static_cast<double>(result.code) + 1.0);
    }
  }
  std::ranges::sort(bins);
  const FineHistogram fine = fine_histogram(place);
  EXPECT_EQ(fine.bin.median, bins[50]);
  EXPECT_EQ(fine.bin.low, bins[3]);
  EXPECT_EQ(fine.bin.high, bins[98]);
  EXPECT_EQ(fine.one_frame.size(), 64U);
  EXPECT_EQ(judge_fine_peak(fine, fine.bin.median).verdict, Verdict::kAgrees);
  EXPECT_EQ(judge_fine_peak(fine, fine.bin.high + 1.0).verdict, Verdict::kDisagrees);
}

TEST(FilteredCounts, TheWideFilterKeepsThePulse) {
  SCOPED_TRACE(test_seed_message());
  const FilteredCounts narrow = filtered_counts(scene(1.0, 100), 0);
  const FilteredCounts wide = filtered_counts(scene(1.0, 100), 46);
  EXPECT_LT(narrow.kept.high, 0.9);
  EXPECT_GT(wide.kept.low, 0.95);
  const Estimate worse{0.05, {0.04, 0.06}};
  const Estimate better{0.02, {0.01, 0.03}};
  EXPECT_EQ(judge_filters(narrow, wide, worse, better).verdict, Verdict::kAgrees);
  EXPECT_EQ(judge_filters(narrow, wide, better, worse).verdict, Verdict::kDisagrees);
  EXPECT_EQ(judge_filters(narrow, wide, worse, worse).verdict, Verdict::kOpen);
  EXPECT_EQ(judge_filters(wide, narrow, worse, better).verdict, Verdict::kDisagrees);
}

TEST(FarPeak, FakesAreCompared) {
  HistogramPeaks near;
  near.fake_share = estimate_rare_share(20, 1000);
  HistogramPeaks far;
  far.fake_share = estimate_rare_share(300, 1000);
  EXPECT_EQ(judge_far_peak(far, near).verdict, Verdict::kAgrees);
  EXPECT_EQ(judge_far_peak(near, far).verdict, Verdict::kDisagrees);
  EXPECT_EQ(judge_far_peak(near, near).verdict, Verdict::kOpen);
}

}  // namespace
}  // namespace dtof
