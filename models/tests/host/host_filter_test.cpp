// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/host_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof_filter.h"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::uint32_t kNone = DTOF_FILTER_INVALID;
constexpr std::uint32_t kMost = DTOF_FILTER_MOST_DEPTH;
/// Tolerance 160 and 1/32 of the depth.
constexpr std::uint32_t kPulse = 2560;

struct Map {
  int columns;
  std::vector<std::uint32_t> depths;
  std::vector<std::uint16_t> confidences = {};

  [[nodiscard]] int rows() const { return static_cast<int>(depths.size()) / columns; }
};

/// The map after the driver's filter. The lines that it may use are framed by words that it must not touch.
std::vector<std::uint32_t> filtered(const Map& map,
                                    const dtof_filter_settings& settings = dtof_filter_defaults(kPulse)) {
  constexpr std::uint32_t kGuard = 0xDEADBEEF;
  std::vector<std::uint32_t> depths = map.depths;
  std::vector<std::uint32_t> lines(DTOF_FILTER_LINES * static_cast<std::size_t>(map.columns) + 2, kGuard);
  EXPECT_TRUE(dtof_filter(&settings, static_cast<std::uint16_t>(map.columns),
                          static_cast<std::uint16_t>(map.rows()), depths.data(),
                          map.confidences.empty() ? nullptr : map.confidences.data(), lines.data() + 1));
  EXPECT_EQ(lines.front(), kGuard);
  EXPECT_EQ(lines.back(), kGuard);
  return depths;
}

/// The filter as accuracy.md defines it, from a copy of the map and in floating point; slow.
std::vector<std::uint32_t> reference(const Map& map, const dtof_filter_settings& settings) {
  double mean = 0.0;
  double valid = 0.0;
  for (std::size_t i = 0; i < map.depths.size(); ++i) {
    if (map.depths[i] <= kMost) {
      mean += map.confidences.empty() ? 0.0 : map.confidences[i];
      valid += 1.0;
    }
  }
  mean = valid > 0.0 ? std::floor(mean / valid + 0.5) : 0.0;
  const auto depth_at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < map.columns && y < map.rows();
    const std::uint32_t depth = inside ? map.depths[static_cast<std::size_t>(y * map.columns + x)] : kNone;
    return depth <= kMost ? static_cast<double>(depth) : std::nan("");
  };
  struct Surface {
    double support = 0.0;
    double depth = 0.0;
  };
  const auto surface = [&](int column, int row, double centre) {
    const double tolerance =
        settings.tolerance + std::floor(centre / std::ldexp(1.0, settings.tolerance_shift));
    Surface found;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const double depth = depth_at(column + dx, row + dy);
        if (std::isnan(depth) || std::abs(depth - centre) > tolerance) {
          continue;
        }
        const auto i = static_cast<std::size_t>((row + dy) * map.columns + column + dx);
        const double weight =
            mean > 0.0 ? std::clamp(std::floor(8.0 * map.confidences[i] / mean), 1.0, 24.0) : 8.0;
        const int ring = std::max(std::abs(dx), std::abs(dy));
        const double share = weight * (ring == 0 ? 4.0 : ring == 1 ? 2.0 : 1.0);
        found.support += share;
        found.depth += share * depth;
      }
    }
    found.depth = std::floor(found.depth / found.support + 0.5);
    return found;
  };
  constexpr int kNeighbours[8][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  std::vector<std::uint32_t> result;
  for (int row = 0; row < map.rows(); ++row) {
    for (int column = 0; column < map.columns; ++column) {
      Surface best;
      for (const auto& [dx, dy] : kNeighbours) {
        if (const double depth = depth_at(column + dx, row + dy); !std::isnan(depth)) {
          const Surface other = surface(column, row, depth);
          best = other.support > best.support ? other : best;
        }
      }
      const double here = depth_at(column, row);
      if (std::isnan(here)) {
        result.push_back(best.support >= settings.fill && best.support > 0.0
                             ? static_cast<std::uint32_t>(best.depth)
                             : kNone);
        continue;
      }
      const Surface own = surface(column, row, here);
      const bool leaves = best.support >= own.support * std::ldexp(1.0, settings.rival_shift);
      result.push_back(static_cast<std::uint32_t>(leaves ? best.depth : own.depth));
    }
  }
  return result;
}

TEST(HostFilter, AMapOfOnePixelStays) {
  EXPECT_THAT(filtered({1, {12345}}), ElementsAre(12345U));
  EXPECT_THAT(filtered({1, {12345}, {0}}), ElementsAre(12345U));
  EXPECT_THAT(filtered({1, {kNone}}), ElementsAre(kNone));
  EXPECT_THAT(filtered({1, {kMost + 1}}), ElementsAre(kNone));
  EXPECT_THAT(filtered({1, {kMost}}), ElementsAre(kMost));
}

TEST(HostFilter, AMapWithoutADepthStays) {
  EXPECT_THAT(filtered({3, std::vector<std::uint32_t>(9, kNone)}), Each(kNone));
  EXPECT_THAT(filtered({3, std::vector<std::uint32_t>(9, kNone), std::vector<std::uint16_t>(9, 7)}),
              Each(kNone));
}

// Weights 4, 2 and 1 by the distance in pixels: (4 * 3200 + 2 * 3220 + 3240) / 7, and so on.
TEST(HostFilter, ALineIsTheWeightedMean) {
  const std::vector<std::uint32_t> line = {3200, 3220, 3240};
  EXPECT_THAT(filtered({3, line}),
              ElementsAre((4 * 3200 + 2 * 3220 + 3240 + 3) / 7, 3220, (3200 + 2 * 3220 + 4 * 3240 + 3) / 7));
  EXPECT_EQ(filtered({1, line}), filtered({3, line}));
}

// 3 x 3: the middle has the support 4 + 8 * 2 = 20 weights.
TEST(HostFilter, TheMiddleOfThreeByThree) {
  Map map{3, {1000, 1000, 1000, 1000, 1100, 1000, 1000, 1000, 1000}};
  EXPECT_EQ(filtered(map)[4], 1020U);  // (4 * 1100 + 16 * 1000) / 20
  // Twice the mean confidence in the middle, which is 9 / 9 = 1: weight 16 instead of 8.
  map.confidences = {1, 1, 1, 1, 2, 1, 1, 1, 1};
  EXPECT_EQ(filtered(map)[4], 1033U);  // (8 * 1100 + 16 * 1000) / 24
}

// Five by five of 1000 around a pixel of 1160: all are within 160 + 31.
TEST(HostFilter, TheMiddleOfFiveByFive) {
  Map map{5, std::vector<std::uint32_t>(25, 1000)};
  map.depths[12] = 1180;
  EXPECT_EQ(filtered(map)[12], 1020U);  // (4 * 1180 + 32 * 1000) / 36
  // 36 more in a ring of 1 pixel beside: (4 * 1180 + 2 * 8 * 1090 + 16 * 1000) / 36 = 1060
  for (const std::size_t near : {6U, 7U, 8U, 11U, 13U, 16U, 17U, 18U}) {
    map.depths[near] = 1090;
  }
  EXPECT_EQ(filtered(map)[12], 1060U);
}

// Tolerance of a surface at 3200: 160 + 100.
TEST(HostFilter, ToleranceIsAConstantAndAShareOfTheDepth) {
  EXPECT_THAT(filtered({2, {3200, 3460}}), ElementsAre((2 * 3200 + 3460 + 1) / 3, (3200 + 2 * 3460 + 1) / 3));
  // 3461 is not on the surface of 3200, but 3200 is on that of 3461: 160 + 108.
  EXPECT_THAT(filtered({2, {3200, 3461}}), ElementsAre(3200, (3200 + 2 * 3461 + 1) / 3));
  EXPECT_THAT(filtered({2, {3200, 3500}}), ElementsAre(3200, 3500));
}

TEST(HostFilter, AStepAndAPoleStay) {
  constexpr int kColumns = 9;
  Map step{kColumns, {}};
  Map pole{kColumns, {}};
  for (int i = 0; i < kColumns * 9; ++i) {
    step.depths.push_back(i % kColumns < 4 ? 10000U : 12000U);
    pole.depths.push_back(i % kColumns == 4 ? 10000U : 30000U);
  }
  EXPECT_EQ(filtered(step), step.depths);
  EXPECT_EQ(filtered(pole), pole.depths);
  // The pole stays although its confidence is low, because its pixels support each other.
  for (int i = 0; i < kColumns * 9; ++i) {
    pole.confidences.push_back(i % kColumns == 4 ? 20 : 100);
  }
  EXPECT_EQ(filtered(pole), pole.depths);
}

// A pixel alone: support 4 * its weight, against (8 * 2 + 16) * 8 = 256 of the wall around, 64 times 4.
TEST(HostFilter, ALonePixelLeavesIfItsConfidenceIsLow) {
  Map map{5, std::vector<std::uint32_t>(25, 20000), std::vector<std::uint16_t>(25, 100)};
  map.depths[12] = 9000;
  EXPECT_EQ(filtered(map)[12], 9000U);
  map.confidences[12] = 27;  // mean 97, weight floor(8 * 27 / 97) = 2
  EXPECT_EQ(filtered(map)[12], 9000U);
  map.confidences[12] = 20;  // mean 97, weight 1; the wall's 8
  EXPECT_EQ(filtered(map)[12], 20000U);
  map.depths[0] = 9000;  // the wall has the support 248 and the pixel 4 + 8: too little against it
  EXPECT_EQ(filtered(map)[12], 9000U);
}

TEST(HostFilter, AnInvalidPixelIsFilledByAWellSupportedSurface) {
  const dtof_filter_settings settings = dtof_filter_defaults(kPulse);
  EXPECT_EQ(settings.fill, 64);
  // Four neighbours of weight 8 have the support 4 * 2 * 8 = 64.
  const std::vector<std::uint32_t> cross = {kNone, 5000, kNone, 5000, kNone, 5010, kNone, 5010, kNone};
  EXPECT_EQ(filtered({3, cross})[4], 5005U);
  std::vector<std::uint32_t> three = cross;
  three[7] = kNone;
  EXPECT_EQ(filtered({3, three})[4], kNone);
  // A confidence of an invalid pixel does not count.
  std::vector<std::uint16_t> confidences(9, 65535);
  for (const std::size_t i : {1U, 3U, 5U, 7U}) {
    confidences[i] = 3;
  }
  EXPECT_EQ(filtered({3, cross, confidences})[4], 5005U);
}

TEST(HostFilter, LargestDepthsAndConfidencesDoNotOverflow) {
  const Map map{5, std::vector<std::uint32_t>(25, kMost), std::vector<std::uint16_t>(25, 65535)};
  EXPECT_THAT(filtered(map), Each(kMost));
  dtof_filter_settings settings = dtof_filter_defaults(UINT32_MAX);
  settings.tolerance = UINT32_MAX;
  settings.tolerance_shift = 0;
  EXPECT_THAT(filtered(map, settings), Each(kMost));
  // One confidence far above the mean: its weight is clipped to 24, the others' is 1.
  Map peak{3, {1000, 1000, 1000, 1000, 1100, 1000, 1000, 1000, 1000}, std::vector<std::uint16_t>(9, 0)};
  peak.confidences[4] = 65535;
  EXPECT_EQ(filtered(peak)[4], (96U * 1100 + 16 * 1000 + 56) / 112);
}

TEST(HostFilter, AMeanConfidenceOfZeroIsNoConfidence) {
  const std::vector<std::uint32_t> depths = {1000, 1010, 1020, 1000, 1100, 1000, 990, 980, 1000};
  EXPECT_EQ(filtered({3, depths, std::vector<std::uint16_t>(9, 0)}), filtered({3, depths}));
}

TEST(HostFilter, RefusesEmptyFramesAndIllegalSettings) {
  dtof_filter_settings settings = dtof_filter_defaults(kPulse);
  std::vector<std::uint32_t> depths = {1000, 1010};
  std::vector<std::uint32_t> lines(6);
  const auto runs = [&](std::uint16_t columns, std::uint16_t rows) {
    return dtof_filter(&settings, columns, rows, depths.data(), nullptr, lines.data());
  };
  EXPECT_FALSE(runs(0, 2));
  EXPECT_FALSE(runs(2, 0));
  settings.tolerance_shift = 32;
  EXPECT_FALSE(runs(2, 1));
  settings.tolerance_shift = 31;
  settings.rival_shift = 32;
  EXPECT_FALSE(runs(2, 1));
  EXPECT_THAT(depths, ElementsAre(1000, 1010));
  settings.rival_shift = 31;
  EXPECT_TRUE(runs(2, 1));
}

TEST(HostFilter, EqualsASlowReferenceOnRandomMaps) {
  std::mt19937_64 random(test_seed());
  const auto below = [&](std::uint64_t limit) { return static_cast<std::uint32_t>(random() % limit); };
  for (int trial = 0; trial < 400; ++trial) {
    Map map{static_cast<int>(1 + below(9)), {}};
    const auto pixels = static_cast<std::size_t>(map.columns) * (1 + below(9));
    const std::uint32_t far = 1000 + below(60000);
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::uint32_t kind = below(10);
      map.depths.push_back(kind == 0 ? kNone : kind < 3 ? below(2 * far) : far + below(far / 10));
      map.confidences.push_back(static_cast<std::uint16_t>(below(kind < 3 ? 4 : 40)));
    }
    if (trial % 4 == 0) {
      map.confidences.clear();
    }
    dtof_filter_settings settings = dtof_filter_defaults(below(6000));
    settings.tolerance_shift = static_cast<std::uint8_t>(3 + below(8));
    settings.rival_shift = static_cast<std::uint8_t>(below(8));
    settings.fill = static_cast<std::uint16_t>(below(200));
    ASSERT_THAT(filtered(map, settings), ElementsAreArray(reference(map, settings)))
        << "trial " << trial << ", " << map.columns << " columns, seed " << test_seed();
  }
}

TEST(FilterDepth, FiltersMetresAsTheDriver) {
  // A pulse of 0.256 m has the tolerance 0.016 m, as kPulse has with a unit of 0.1 mm.
  std::vector<double> metres = {0.32, 0.346, 0.5, -0.1, std::nan(""), 0.35};
  const std::vector<std::uint16_t> confidences = {3, 9, 1, 2, 5, 7};
  const std::vector<std::uint32_t> expected = filtered({3, {3200, 3460, 5000, 0, kNone, 3500}, confidences});
  filter_depth(metres, confidences, 3, 0.256);
  for (std::size_t i = 0; i < metres.size(); ++i) {
    EXPECT_EQ(expected[i] == kNone, std::isnan(metres[i]));
    EXPECT_DOUBLE_EQ(std::isnan(metres[i]) ? kNone : metres[i],
                     expected[i] == kNone ? kNone : expected[i] * 1e-4);
  }
}

TEST(FilterDepth, ConfidencesKeepTheirRatios) {
  EXPECT_THAT(filter_confidences(std::vector<double>{0, 7, 65535}), ElementsAre(0, 7, 65535));
  EXPECT_THAT(filter_confidences(std::vector<double>{0.5, 1.5, 1.0}), ElementsAre(512, 1536, 1024));
  // A negative score counts as 0; 100 times the mean is clipped.
  EXPECT_THAT(filter_confidences(std::vector<double>{-1.5, 3.0, 1.5}), ElementsAre(0, 2048, 1024));
  std::vector<double> one(200, 0.0);
  one[3] = 0.25;
  EXPECT_EQ(filter_confidences(one)[3], 65535);
  EXPECT_THAT(filter_confidences(std::vector<double>{-0.5, -2.0}), ElementsAre(0, 0));
  EXPECT_TRUE(filter_confidences({}).empty());
}

TEST(FilterDepth, RefusesWhatIsNoMap) {
  std::vector<double> metres = {1.0, 2.0, 3.0};
  const std::vector<std::uint16_t> confidences = {1, 2};
  EXPECT_THAT([&] { filter_depth(metres, {}, 2, 0.3); },
              ThrowsMessage<InputError>(HasSubstr("3 pixels and 0 confidences are no map of 2 columns")));
  EXPECT_THROW(filter_depth(metres, {}, 0, 0.3), InputError);
  EXPECT_THROW(filter_depth(metres, {}, -3, 0.3), InputError);
  EXPECT_THROW(filter_depth(metres, confidences, 3, 0.3), InputError);
  EXPECT_THROW(filter_depth({}, {}, 3, 0.3), InputError);
  for (const double pulse : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT([&] { filter_depth(metres, {}, 3, pulse); },
                ThrowsMessage<InputError>(HasSubstr("host filter: a pulse of")));
  }
}

TEST(FilterDepth, ThePulseIsHalfTheWayOfLight) { EXPECT_NEAR(pulse_distance_m(2e-9), 0.2998, 1e-4); }

}  // namespace
}  // namespace dtof
