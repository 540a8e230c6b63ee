// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/host_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
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

  [[nodiscard]] int rows() const { return static_cast<int>(depths.size()) / columns; }
};

/// The map after the driver's filter. The lines that it may use lie between words that it must not touch.
std::vector<std::uint32_t> filtered(const Map& map,
                                    const dtof_filter_settings& settings = dtof_filter_defaults(kPulse)) {
  constexpr std::uint32_t kGuard = 0xDEADBEEF;
  std::vector<std::uint32_t> depths = map.depths;
  std::vector<std::uint32_t> lines(DTOF_FILTER_LINES * static_cast<std::size_t>(map.columns) + 2, kGuard);
  EXPECT_TRUE(dtof_filter(&settings, static_cast<std::uint16_t>(map.columns),
                          static_cast<std::uint16_t>(map.rows()), depths.data(), lines.data() + 1));
  EXPECT_EQ(lines.front(), kGuard);
  EXPECT_EQ(lines.back(), kGuard);
  return depths;
}

/// The filter as accuracy.md defines it, from a copy of the map and in floating point; slow.
std::vector<std::uint32_t> reference(const Map& map, const dtof_filter_settings& settings) {
  const auto depth_at = [&](int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < map.columns && y < map.rows();
    const std::uint32_t depth = inside ? map.depths[static_cast<std::size_t>(y * map.columns + x)] : kNone;
    return depth <= kMost ? static_cast<double>(depth) : std::nan("");
  };
  const auto on_surface = [&](int column, int row, double centre) {
    const double tolerance =
        settings.tolerance + std::floor(centre / std::ldexp(1.0, settings.tolerance_shift));
    std::vector<double> found;
    for (int y = row - 2; y <= row + 2; ++y) {
      for (int x = column - 2; x <= column + 2; ++x) {
        if (std::abs(depth_at(x, y) - centre) <= tolerance) {
          found.push_back(depth_at(x, y));
        }
      }
    }
    return found;
  };
  const auto mean = [](const std::vector<double>& depths) {
    double sum = 0.0;
    for (const double depth : depths) {
      sum += depth;
    }
    return static_cast<std::uint32_t>(std::floor(sum / static_cast<double>(depths.size()) + 0.5));
  };
  constexpr int kNeighbours[8][2] = {{0, -1}, {-1, 0}, {1, 0}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  std::vector<std::uint32_t> result;
  for (int row = 0; row < map.rows(); ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const double here = depth_at(column, row);
      const std::vector<double> own = on_surface(column, row, here);
      if (own.size() > 1) {
        result.push_back(mean(own));
        continue;
      }
      std::vector<double> best;
      for (const auto& [dx, dy] : kNeighbours) {
        const std::vector<double> other = on_surface(column, row, depth_at(column + dx, row + dy));
        best = other.size() > best.size() ? other : best;
      }
      const double all = std::numeric_limits<double>::max();
      std::size_t others = 0;
      for (int y = row - 2; y <= row + 2; ++y) {
        for (int x = column - 2; x <= column + 2; ++x) {
          others += (x != column || y != row) && depth_at(x, y) < all ? 1 : 0;
        }
      }
      if (others >= 8 && static_cast<double>(best.size()) / static_cast<double>(others) > 2.0 / 3.0 - 1e-9) {
        result.push_back(mean(best));
      } else {
        result.push_back(std::isnan(here) ? kNone : static_cast<std::uint32_t>(here));
      }
    }
  }
  return result;
}

TEST(HostFilter, AMapOfOnePixelStays) {
  EXPECT_THAT(filtered({1, {12345}}), ElementsAre(12345U));
  EXPECT_THAT(filtered({1, {kNone}}), ElementsAre(kNone));
  EXPECT_THAT(filtered({1, {kMost + 1}}), ElementsAre(kNone));
  EXPECT_THAT(filtered({1, {kMost}}), ElementsAre(kMost));
}

TEST(HostFilter, AMapWithoutADepthStays) {
  EXPECT_THAT(filtered({5, std::vector<std::uint32_t>(25, kNone)}), Each(kNone));
}

// Two pixels to each side. Only pixels within the tolerance of the own depth count: 160 and 100 of 3200.
TEST(HostFilter, ALineIsTheMeanOfFivePixels) {
  const std::vector<std::uint32_t> line = {3200, 3210, 3230, 3240, 3250, 9000};
  const std::vector<std::uint32_t> expected = {3213, 3220, 3226, 3233, 3240, 9000};  // 3213.3, 3232.5
  EXPECT_EQ(filtered({6, line}), expected);
  EXPECT_EQ(filtered({1, line}), expected);
}

TEST(HostFilter, TheMiddleOfThreeByThree) {
  const Map map{3, {1000, 1000, 1000, 1000, 1090, 1000, 1000, 1000, 1000}};
  EXPECT_THAT(filtered(map), Each(1010U));  // 8 * 1000 + 1090, of all nine pixels for each
}

// Five by five of 1000: 24 * 1000 + 1150. The pixels of the sixth column are too far away.
TEST(HostFilter, TheMiddleOfFiveByFive) {
  Map map{6, std::vector<std::uint32_t>(36, 1000)};
  map.depths[14] = 1150;
  EXPECT_EQ(filtered(map)[14], 1006U);
  for (const std::size_t beside : {5U, 11U, 17U, 23U, 29U, 35U, 30U, 31U, 32U, 33U, 34U}) {
    map.depths[beside] = 1100;
  }
  EXPECT_EQ(filtered(map)[14], 1006U);
}

// Tolerance of a surface at 3200: 160 + 100.
TEST(HostFilter, ToleranceIsAConstantAndAShareOfTheDepth) {
  EXPECT_THAT(filtered({2, {3200, 3460}}), ElementsAre(3330, 3330));
  // 3461 is not on the surface of 3200, but 3200 is on that of 3461: 160 + 108.
  EXPECT_THAT(filtered({2, {3200, 3461}}), ElementsAre(3200, 3331));
  EXPECT_THAT(filtered({2, {3200, 3500}}), ElementsAre(3200, 3500));
}

TEST(HostFilter, AStepAndAPoleStay) {
  constexpr int kColumns = 9;
  Map step{kColumns, {}};
  Map pole{kColumns, {}};
  Map slanted{kColumns, {}};
  for (int i = 0; i < kColumns * 9; ++i) {
    step.depths.push_back(i % kColumns < 4 ? 10000U : 12000U);
    pole.depths.push_back(i % kColumns == 4 ? 10000U : 30000U);
    slanted.depths.push_back(i % kColumns == i / kColumns ? 10000U : 30000U);
  }
  EXPECT_EQ(filtered(step), step.depths);
  EXPECT_EQ(filtered(pole), pole.depths);
  EXPECT_EQ(filtered(slanted), slanted.depths);
}

// The middle of 24 others: 16 of them are two thirds.
TEST(HostFilter, ALonePixelTakesTheSurfaceOfTwoThirdsOfTheOthers) {
  Map map{5, std::vector<std::uint32_t>(25, 20000)};
  map.depths[12] = 9000;
  EXPECT_EQ(filtered(map)[12], 20000U);
  for (const std::size_t away : {0U, 1U, 2U, 3U, 4U, 5U, 9U, 10U}) {
    map.depths[away] = 40000;
  }
  EXPECT_EQ(filtered(map)[12], 20000U);
  map.depths[14] = 40000;
  EXPECT_EQ(filtered(map)[12], 9000U);
  // A second pixel at 9000: not alone any more.
  Map two{5, std::vector<std::uint32_t>(25, 20000)};
  two.depths[12] = two.depths[24] = 9000;
  EXPECT_EQ(filtered(two)[12], 9000U);
}

// The window at a corner has three by three pixels; six of the eight others are two thirds and more.
TEST(HostFilter, ALonePixelInACornerNeedsSixOfEight) {
  Map map{3, {9000, 20000, 20000, 20000, 20000, 20000, 20000, 40000, 40000}};
  EXPECT_EQ(filtered(map)[0], 20000U);
  map.depths[6] = 40000;
  EXPECT_EQ(filtered(map)[0], 9000U);
  // With an invalid pixel seven others remain, which are too few.
  EXPECT_EQ(filtered({3, {9000, 20000, 20000, 20000, 20000, 20000, 20000, 20000, kNone}})[0], 9000U);
}

// Only a neighbour's surface can be taken, and of two equally large ones the upper, then the left one.
TEST(HostFilter, ThePixelTakesANeighboursSurface) {
  Map map{5, std::vector<std::uint32_t>(25, 20000)};
  map.depths[12] = 9000;
  for (const std::size_t near : {6U, 7U, 8U, 11U, 13U, 16U, 17U, 18U}) {
    map.depths[near] = 40000 + 10000 * static_cast<std::uint32_t>(near);
  }
  EXPECT_EQ(filtered(map)[12], 9000U);
  map.depths[18] = 20000;  // with the ring outside 17 of 24
  EXPECT_EQ(filtered(map)[12], 20000U);
}

TEST(HostFilter, AnInvalidPixelIsFilledAsALoneOneIs) {
  Map map{5, std::vector<std::uint32_t>(25, 5000)};
  map.depths[12] = kNone;
  map.depths[7] = 5025;
  EXPECT_EQ(filtered(map)[12], 5001U);  // 5001.04
  for (std::size_t i = 16; i < 25; ++i) {
    map.depths[i] = 60000 + 20000 * static_cast<std::uint32_t>(i);
  }
  EXPECT_EQ(filtered(map)[12], kNone);  // 15 of 24
  // Six of eight valid others are enough; the rest may be invalid.
  Map few{5, std::vector<std::uint32_t>(25, kNone)};
  for (const std::size_t i : {6U, 7U, 8U, 11U, 13U, 16U}) {
    few.depths[i] = 7000;
  }
  few.depths[0] = 30000;
  EXPECT_EQ(filtered(few)[12], kNone);  // seven others
  few.depths[24] = 60000;
  EXPECT_EQ(filtered(few)[12], 7000U);
}

TEST(HostFilter, LargestDepthsDoNotOverflow) {
  const Map map{5, std::vector<std::uint32_t>(25, kMost)};
  EXPECT_THAT(filtered(map), Each(kMost));
  dtof_filter_settings settings = dtof_filter_defaults(UINT32_MAX);
  EXPECT_EQ(settings.tolerance, UINT32_MAX / 16);
  settings.tolerance = UINT32_MAX;
  settings.tolerance_shift = 0;
  EXPECT_THAT(filtered(map, settings), Each(kMost));
  EXPECT_THAT(filtered({2, {kMost, 0}}, settings), ElementsAre((kMost + 1) / 2, (kMost + 1) / 2));
}

TEST(HostFilter, RefusesEmptyFramesAndIllegalSettings) {
  dtof_filter_settings settings = dtof_filter_defaults(kPulse);
  std::vector<std::uint32_t> depths = {1000, 1010};
  std::vector<std::uint32_t> lines(6);
  const auto runs = [&](std::uint16_t columns, std::uint16_t rows) {
    return dtof_filter(&settings, columns, rows, depths.data(), lines.data());
  };
  EXPECT_FALSE(runs(0, 2));
  EXPECT_FALSE(runs(2, 0));
  settings.tolerance_shift = 32;
  EXPECT_FALSE(runs(2, 1));
  EXPECT_THAT(depths, ElementsAre(1000, 1010));
  settings.tolerance_shift = 31;
  EXPECT_TRUE(runs(2, 1));
  EXPECT_THAT(depths, ElementsAre(1005, 1005));
}

TEST(HostFilter, EqualsASlowReferenceOnRandomMaps) {
  std::mt19937_64 random(test_seed());
  const auto below = [&](std::uint64_t limit) { return static_cast<std::uint32_t>(random() % limit); };
  int alone = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Map map{static_cast<int>(1 + below(9)), {}};
    const auto pixels = static_cast<std::size_t>(map.columns) * (1 + below(9));
    const std::uint32_t far = 1000 + below(60000);
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::uint32_t kind = below(16);
      map.depths.push_back(kind == 0 ? kNone : kind < 3 ? below(2 * far) : far + below(far / 10));
    }
    dtof_filter_settings settings = dtof_filter_defaults(below(30000));
    settings.tolerance_shift = static_cast<std::uint8_t>(3 + below(8));
    const std::vector<std::uint32_t> result = filtered(map, settings);
    ASSERT_THAT(result, ElementsAreArray(reference(map, settings)))
        << "trial " << trial << ", " << map.columns << " columns, " << test_seed_message();
    for (std::size_t i = 0; i < pixels; ++i) {
      alone += map.depths[i] == kNone && result[i] != kNone ? 1 : 0;
    }
  }
  EXPECT_GT(alone, 20) << "the maps have hardly a pixel that another surface fills";
}

TEST(FilterDepth, FiltersMetresAsTheDriver) {
  // A pulse of 0.256 m has the tolerance 0.016 m, as kPulse has with a unit of 0.1 mm.
  std::vector<double> metres = {0.32, 0.346, 0.5, -0.1, std::nan(""), 0.35};
  const std::vector<std::uint32_t> expected = filtered({3, {3200, 3460, 5000, 0, kNone, 3500}});
  filter_depth(metres, 3, 0.256);
  for (std::size_t i = 0; i < metres.size(); ++i) {
    EXPECT_EQ(expected[i] == kNone, std::isnan(metres[i]));
    EXPECT_DOUBLE_EQ(std::isnan(metres[i]) ? kNone : metres[i],
                     expected[i] == kNone ? kNone : expected[i] * 1e-4);
  }
}

TEST(FilterDepth, RefusesWhatIsNoMap) {
  std::vector<double> metres = {1.0, 2.0, 3.0};
  EXPECT_THAT([&] { filter_depth(metres, 2, 0.3); },
              ThrowsMessage<InputError>(HasSubstr("3 pixels are no map of 2 columns")));
  EXPECT_THROW(filter_depth(metres, 0, 0.3), InputError);
  EXPECT_THROW(filter_depth(metres, -3, 0.3), InputError);
  EXPECT_THROW(filter_depth({}, 3, 0.3), InputError);
  std::vector<double> line(65536, 1.0);
  EXPECT_THROW(filter_depth(line, 65536, 0.3), InputError);
  EXPECT_THROW(filter_depth(line, 1, 0.3), InputError);
  for (const double pulse : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT([&] { filter_depth(metres, 3, pulse); },
                ThrowsMessage<InputError>(HasSubstr("host filter: a pulse of")));
  }
}

TEST(FilterDepth, ThePulseIsHalfTheWayOfLight) { EXPECT_NEAR(pulse_distance_m(2e-9), 0.2998, 1e-4); }

}  // namespace
}  // namespace dtof
