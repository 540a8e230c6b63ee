// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/cfar_detector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Timestamps with `counts` detections in the middle of the bins, bin by bin in this order.
std::vector<int> in_bins(const std::vector<std::pair<int, int>>& bin_counts) {
  std::vector<int> timestamps;
  for (const auto& [bin, count] : bin_counts) {
    timestamps.insert(timestamps.end(), static_cast<std::size_t>(count), 32 * bin + 16);
  }
  return timestamps;
}

TEST(CfarDetector, BitsOfAPixel) {
  EXPECT_EQ(make_cfar_detector(SensorModel(), {})->bits_per_pixel(), 32 * 8 + 1);
  EXPECT_EQ(make_cfar_detector(SensorModel(), {.early = false})->bits_per_pixel(), 32 * 8);
}

// Without background r = 0 and m = 8: (8 y)^2 >= 36 * 8 * 16, y >= 8.5. The ninth detection reports.
TEST(CfarDetector, ReportsAPulseInTheDark) {
  const std::unique_ptr<Rival> cfar = make_cfar_detector(SensorModel(), {});
  const RivalWords words = read_one_frame(*cfar, one_each(in_bins({{10, 20}})));
  EXPECT_THAT(words, ElementsAre(10, 0, 9, 0, 0, 8, 8));
  EXPECT_DOUBLE_EQ(cfar->decode(words).position, 10.5 * 32.0 - 0.5);
  EXPECT_NEAR(cfar->decode(words).confidence, 9.0 / std::sqrt(2.0), 1e-12);
  EXPECT_THAT(read_one_frame(*cfar, one_each(in_bins({{10, 8}}))), ElementsAre(10, 0, 8, 0, 0, 8, 3333));
  // At the range's ends there are four reference bins.
  EXPECT_THAT(read_one_frame(*cfar, one_each(in_bins({{0, 20}}))), ElementsAre(0, 0, 9, 0, 0, 4, 8));
  EXPECT_THAT(read_one_frame(*cfar, one_each(in_bins({{31, 20}}))), ElementsAre(31, 0, 9, 0, 0, 4, 8));
}

// Two detections in each reference bin: (8 y - 16)^2 >= 36 * 8 * 16, y >= 10.5.
TEST(CfarDetector, TheThresholdFollowsTheBackground) {
  const std::unique_ptr<Rival> cfar = make_cfar_detector(SensorModel(), {});
  const std::vector<int> timestamps =
      in_bins({{4, 2}, {5, 2}, {6, 2}, {7, 2}, {13, 2}, {14, 2}, {15, 2}, {16, 2}, {10, 20}});
  EXPECT_THAT(read_one_frame(*cfar, one_each(timestamps)), ElementsAre(10, 0, 11, 0, 16, 8, 16 + 10));
}

// Guard bins do not raise the threshold; two of them are in the centroid: (4 - 2) / (2 + 9 + 4) bins.
TEST(CfarDetector, TheCentroidIsOfThreeBins) {
  const std::unique_ptr<Rival> cfar = make_cfar_detector(SensorModel(), {});
  const RivalWords words =
      read_one_frame(*cfar, one_each(in_bins({{8, 7}, {9, 2}, {11, 4}, {12, 7}, {10, 9}})));
  EXPECT_THAT(words, ElementsAre(10, 2, 9, 4, 0, 8, 20 + 8));
  EXPECT_NEAR(cfar->decode(words).position, (10.5 + 2.0 / 15.0) * 32.0 - 0.5, 1e-9);
}

TEST(CfarDetector, WithoutEarlyReportsTheWholeFrameCounts) {
  const std::unique_ptr<Rival> whole = make_cfar_detector(SensorModel(), {.count_bits = 4, .early = false});
  EXPECT_THAT(read_one_frame(*whole, one_each(in_bins({{3, 12}, {20, 14}}))),
              ElementsAre(20, 0, 14, 0, 0, 8, 3333));
  // The 16th detection in a bin of 4 bits ends the count of all bins.
  EXPECT_THAT(read_one_frame(*whole, one_each(in_bins({{21, 3}, {20, 15}, {21, 2}, {20, 1}, {21, 5}}))),
              ElementsAre(20, 0, 15, 5, 0, 8, 3333));
}

// The rate of false alarms that the header states, with four standard deviations of 400 pixels.
TEST(CfarDetector, BackgroundAloneSeldomReports) {
  const std::unique_ptr<Rival> cfar = make_cfar_detector(SensorModel(), {});
  SplitMix64 random(CounterRandom(1, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0));
  int reports = 0;
  for (int pixel = 0; pixel < 400; ++pixel) {
    std::vector<int> timestamps(1000);
    std::ranges::generate(timestamps, [&] { return static_cast<int>((random() >> 11U) % 1023); });
    reports += read_one_frame(*cfar, one_each(timestamps))[6] < 3333 ? 1 : 0;
  }
  EXPECT_LE(reports, 12);
}

TEST(CfarDetector, RefusesOtherSizes) {
  EXPECT_THAT([] { (void)make_cfar_detector(SensorModel(), {.bin_bits = 3}); },
              ThrowsMessage<InputError>(HasSubstr("2^3 bins of 8 bits")));
  EXPECT_THAT([] { (void)make_cfar_detector(SensorModel(), {.count_bits = 17}); },
              ThrowsMessage<InputError>(HasSubstr("4 to 16")));
}

// Two counts with a mean of 1 are equal with probability e^-2 I0(2) = 0.308508.
TEST(RawPeakProbability, ByHand) {
  EXPECT_NEAR(raw_peak_probability(std::array{1.0, 1.0}, 0), 0.5 * (1.0 + 0.308508), 1e-6);
  EXPECT_NEAR(raw_peak_probability(std::array{1.0, 1.0}, 1), 0.5 * (1.0 - 0.308508), 1e-6);
  EXPECT_NEAR(raw_peak_probability(std::array{0.0, 2.0}, 1), 1.0 - std::exp(-2.0), 1e-12);
  EXPECT_NEAR(raw_peak_probability(std::array{2.0, 0.0}, 0), 1.0, 1e-12);
}

TEST(RawPeakProbability, SumsToOne) {
  const std::array means = {3.0, 5.5, 40.0, 38.0};
  double sum = 0.0;
  for (std::size_t bin = 0; bin < means.size(); ++bin) {
    sum += raw_peak_probability(means, bin);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

}  // namespace
}  // namespace dtof
