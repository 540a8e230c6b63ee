// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/lookup_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

using Points = std::vector<CalibrationPoint>;

TEST(LookupTable, MonotonePointsAreKeptAndJoinedByLines) {
  const LookupTable table = LookupTable::fit(Points{{20, 2.0}, {10, 1.0}, {40, 3.0}});
  EXPECT_THAT(table.knots(),
              ElementsAre(CalibrationPoint{10, 1.0}, CalibrationPoint{20, 2.0}, CalibrationPoint{40, 3.0}));
  EXPECT_DOUBLE_EQ(table.distance(10), 1.0);
  EXPECT_DOUBLE_EQ(table.distance(15), 1.5);
  EXPECT_DOUBLE_EQ(table.distance(35), 2.75);
  EXPECT_DOUBLE_EQ(table.distance(40), 3.0);
}

TEST(LookupTable, ContinuesWithTheMeanSlopeBeyondItsEnds) {
  const LookupTable table = LookupTable::fit(Points{{10, 1.0}, {20, 2.5}, {30, 3.0}});
  EXPECT_DOUBLE_EQ(table.distance(5), 0.5);
  EXPECT_DOUBLE_EQ(table.distance(40), 4.0);
}

TEST(LookupTable, ViolatorsArePooledAtTheirMean) {
  const LookupTable table = LookupTable::fit(Points{{1, 1.0}, {2, 3.0}, {3, 2.0}, {4, 1.0}, {5, 6.0}});
  EXPECT_THAT(table.knots(),
              ElementsAre(CalibrationPoint{1, 1.0}, CalibrationPoint{3, 2.0, 3.0}, CalibrationPoint{5, 6.0}));
}

TEST(LookupTable, PoolingReachesBack) {
  const LookupTable table = LookupTable::fit(Points{{1, 4.0}, {2, 5.0}, {3, 6.0}, {4, 1.0}});
  EXPECT_THAT(table.knots(), ElementsAre(CalibrationPoint{2.5, 4.0, 4.0}));
}

TEST(LookupTable, WeightsCountAsRepetitions) {
  const LookupTable table = LookupTable::fit(Points{{1, 1.0}, {2, 3.0, 3.0}, {4, 2.0}, {5, 6.0}});
  EXPECT_THAT(table.knots(), ElementsAre(CalibrationPoint{1, 1.0}, CalibrationPoint{2.5, 2.75, 4.0},
                                         CalibrationPoint{5, 6.0}));
  EXPECT_THAT(
      [] {
        LookupTable::fit(Points{{1, 1.0}, {2, 2.0, 0.0}});
      },
      ThrowsMessage<InputError>(HasSubstr("weight is 0")));
}

TEST(LookupTable, SpreadCodesOfOneDistanceBecomeOneKnot) {
  const LookupTable table = LookupTable::fit(Points{{9, 1.0}, {10, 1.0}, {11, 1.0}, {20, 2.0}});
  EXPECT_DOUBLE_EQ(table.distance(10), 1.0);
  EXPECT_LT(table.distance(9), 1.0);
  EXPECT_GT(table.distance(11), 1.0);
}

TEST(LookupTable, RepeatedCodesAreAveragedFirst) {
  const LookupTable table = LookupTable::fit(Points{{10, 1.0}, {10, 1.0}, {10, 4.0}, {20, 3.0}});
  EXPECT_DOUBLE_EQ(table.distance(10), 2.0);
  EXPECT_DOUBLE_EQ(table.distance(20), 3.0);
}

TEST(LookupTable, FlatAndFallingDataGiveTheirMean) {
  const LookupTable flat = LookupTable::fit(Points{{512, 1.0}, {512, 2.0}, {512, 6.0}});
  EXPECT_DOUBLE_EQ(flat.distance(512), 3.0);
  EXPECT_DOUBLE_EQ(flat.distance(0), 3.0);
  const LookupTable falling = LookupTable::fit(Points{{1, 3.0}, {2, 2.0}, {3, 1.0}});
  EXPECT_DOUBLE_EQ(falling.distance(100), 2.0);
}

TEST(LookupTable, RandomFitsAreMonotoneAndFollowTheMinimaxFormula) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 1, 0);
  for (int round = 0; round < 200; ++round) {
    Points points;
    const std::uint32_t count = 2 + random() % 60;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto position = static_cast<double>(random() % 40);
      points.push_back({position, 0.1 * position + 3.0 * random.uniform()});
    }
    const LookupTable table = LookupTable::fit(points);
    const auto not_ascending = [](const CalibrationPoint& a, const CalibrationPoint& b) {
      return a.position >= b.position || a.distance_m >= b.distance_m;
    };
    ASSERT_EQ(std::ranges::adjacent_find(table.knots(), not_ascending), table.knots().end());

    // Isotonic regression by its minimax formula: max over i <= k of min over j >= k of mean(i .. j).
    const auto mean_between = [&points](double low, double high) {
      double sum = 0.0;
      int members = 0;
      for (const CalibrationPoint& point : points) {
        if (point.position >= low && point.position <= high) {
          sum += point.distance_m;
          ++members;
        }
      }
      return sum / members;
    };
    std::vector<double> positions;
    for (const CalibrationPoint& point : points) {
      positions.push_back(point.position);
    }
    std::ranges::sort(positions);
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    for (std::size_t k = 0; k < positions.size(); ++k) {
      double fitted = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i <= k; ++i) {
        double lowest = std::numeric_limits<double>::infinity();
        for (std::size_t j = k; j < positions.size(); ++j) {
          lowest = std::min(lowest, mean_between(positions[i], positions[j]));
        }
        fitted = std::max(fitted, lowest);
      }
      const bool is_a_level = std::ranges::any_of(table.knots(), [fitted](const CalibrationPoint& knot) {
        return std::abs(knot.distance_m - fitted) < 1e-9;
      });
      ASSERT_TRUE(is_a_level) << "round " << round << ", position " << positions[k];
    }
  }
}

TEST(LookupTable, RefusesTooFewOrInvalidPoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([] { LookupTable::fit({}); },
              ThrowsMessage<InputError>(HasSubstr("at least 2 calibration points, but there are 0")));
  EXPECT_THAT(
      [] {
        LookupTable::fit(Points{{1, 1.0}});
      },
      ThrowsMessage<InputError>(HasSubstr("at least 2 calibration points, but there are 1")));
  EXPECT_THAT(
      [=] {
        LookupTable::fit(Points{{1, 1.0}, {nan, 2.0}});
      },
      ThrowsMessage<InputError>(HasSubstr("is not finite")));
  EXPECT_THAT(
      [=] {
        LookupTable::fit(Points{{1, 1.0}, {2, nan}});
      },
      ThrowsMessage<InputError>(HasSubstr("is not finite")));
}

}  // namespace
}  // namespace dtof
