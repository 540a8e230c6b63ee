// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/trainer/training_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

namespace dtof {
namespace {

/// Neighbours to the right whose depth differs by more than 10 %.
int edges(const TargetMap& map) {
  int count = 0;
  for (int row = 0; row < map.rows(); ++row) {
    for (int column = 1; column < map.columns(); ++column) {
      const double left = map.at(column - 1, row).depth_m;
      count += std::abs(map.at(column, row).depth_m - left) > 0.1 * left ? 1 : 0;
    }
  }
  return count;
}

TEST(TrainingScene, EveryPixelHasATargetWithinReach) {
  for (std::uint32_t number = 0; number < 20; ++number) {
    const TargetMap map = make_training_scene(200, 160, 3, number);
    map.validate();
    std::set<double> reflectivities;
    for (int row = 0; row < map.rows(); ++row) {
      for (int column = 0; column < map.columns(); ++column) {
        const PixelTarget& target = map.at(column, row);
        ASSERT_GE(target.depth_m, 0.4) << number << ": " << column << ", " << row;
        ASSERT_LE(target.depth_m, 6.0) << number << ": " << column << ", " << row;
        ASSERT_GE(target.reflectivity, 0.05 - 1e-9);
        ASSERT_LE(target.reflectivity, 1.0);
        reflectivities.insert(target.reflectivity);
      }
    }
    EXPECT_GT(reflectivities.size(), 5U) << number;
    EXPECT_GT(edges(map), 300) << number;
  }
}

TEST(TrainingScene, FollowsFromSeedAndNumberAlone) {
  const auto same = [](const TargetMap& first, const TargetMap& second) {
    for (int column = 0; column < first.columns(); ++column) {
      for (int row = 0; row < first.rows(); ++row) {
        if (first.at(column, row).depth_m != second.at(column, row).depth_m ||
            first.at(column, row).reflectivity != second.at(column, row).reflectivity) {
          return false;
        }
      }
    }
    return true;
  };
  const TargetMap map = make_training_scene(60, 50, 3, 8);
  EXPECT_TRUE(same(make_training_scene(60, 50, 3, 8), map));
  EXPECT_FALSE(same(make_training_scene(60, 50, 3, 9), map));
  EXPECT_FALSE(same(make_training_scene(60, 50, 4, 8), map));
}

}  // namespace
}  // namespace dtof
