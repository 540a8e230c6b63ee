// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/enlarger.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

SmallMap map_of(const SpotGrid& grid, const std::function<double(int x, int y)>& distance) {
  SmallMap map{grid, {}, {}};
  for (const int y : grid.y) {
    for (const int x : grid.x) {
      map.distance_m.push_back(distance(x, y));
      map.confidence.push_back(1.0);
    }
  }
  return map;
}

IntensityImage image_of(const SpotGrid& grid, const std::function<double(int x, int y)>& value) {
  IntensityImage image{grid.columns, grid.rows, {}};
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      image.values.push_back(value(x, y));
    }
  }
  return image;
}

TEST(Enlarger, NearestRepeatsSpots) {
  const SmallMap map = map_of(make_spot_grid(6, 2, 2, 1), [](int x, int) { return x; });  // spots at 1 and 4
  EXPECT_THAT(enlarge_nearest(map), ElementsAre(1, 1, 1, 4, 4, 4, 1, 1, 1, 4, 4, 4));
}

TEST(Enlarger, BilinearGivesAPlaneBackBetweenTheSpots) {
  const auto plane = [](int x, int y) { return 1.0 + 0.25 * x - 0.125 * y + 0.03125 * x * y; };
  const SpotGrid grid = make_spot_grid(20, 16, 8, 5);
  const std::vector<double> large = enlarge_bilinear(map_of(grid, plane));
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      const int inner_x = std::clamp(x, grid.x.front(), grid.x.back());  // beyond the spots, their border's
      const int inner_y = std::clamp(y, grid.y.front(), grid.y.back());
      EXPECT_NEAR(large[static_cast<std::size_t>(y * grid.columns + x)], plane(inner_x, inner_y), 1e-12)
          << x << ", " << y;
    }
  }
}

TEST(Enlarger, AWideJointBilateralIsTheMeanOfItsSpots) {
  // 5 x 5 spots, so that the pixel in the middle sees all of them, and those of the border fewer.
  const SpotGrid grid = make_spot_grid(15, 15, 5, 5);
  const SmallMap map = map_of(grid, [](int x, int y) { return 1.0 + x + 20.0 * y; });
  const std::vector<double> large =
      enlarge_joint_bilateral(map, image_of(grid, [](int x, int) { return x; }), {1e9, 1e9});
  EXPECT_NEAR(large[7 * 15 + 7], 1.0 + 7.0 + 20.0 * 7.0, 1e-9);
  EXPECT_NEAR(large[0], 1.0 + (1 + 4 + 7) / 3.0 + 20.0 * (1 + 4 + 7) / 3.0, 1e-9);
}

TEST(Enlarger, AJointBilateralWithoutAnImageIsAGaussianOfTheDistance) {
  const SpotGrid grid = make_spot_grid(6, 1, 2, 1);  // spots at 1 and 4, 3 pixels apart
  const SmallMap map = map_of(grid, [](int x, int) { return x == 1 ? 1.0 : 2.0; });
  const std::vector<double> large =
      enlarge_joint_bilateral(map, image_of(grid, [](int, int) { return 7.0; }), {0.5, 0.1});
  for (int x = 0; x < 6; ++x) {
    const double first = std::exp(-2.0 * std::pow((x - 1) / 3.0, 2));
    const double second = std::exp(-2.0 * std::pow((x - 4) / 3.0, 2));
    EXPECT_NEAR(large[static_cast<std::size_t>(x)], (first + 2.0 * second) / (first + second), 1e-12) << x;
  }
}

TEST(Enlarger, AJointBilateralWeighsBrightnessAsItsWidthSays) {
  const SpotGrid grid = make_spot_grid(6, 1, 2, 1);
  const SmallMap map = map_of(grid, [](int x, int) { return x == 1 ? 1.0 : 2.0; });
  const IntensityImage image = image_of(grid, [](int x, int) { return x < 2 ? 1.0 : 4.0; });  // mean 3
  const std::vector<double> large = enlarge_joint_bilateral(map, image, {1e9, 0.4});
  const double unlike = std::exp(-0.5 * std::pow((std::sqrt(4.0 / 3.0) - std::sqrt(1.0 / 3.0)) / 0.4, 2));
  EXPECT_NEAR(large[0], (1.0 + 2.0 * unlike) / (1.0 + unlike), 1e-12);
  EXPECT_NEAR(large[2], (unlike + 2.0) / (unlike + 1.0), 1e-12);
  EXPECT_NEAR(large[5], large[2], 1e-12);
}

TEST(Enlarger, AJointBilateralFollowsTheEdgeOfTheImage) {
  const SpotGrid grid = make_spot_grid(20, 20, 5, 5);
  const auto left = [](int x, int y) { return x + y < 19; };
  const SmallMap map = map_of(grid, [&](int x, int y) { return left(x, y) ? 1.0 : 3.0; });
  const IntensityImage image = image_of(grid, [&](int x, int y) { return left(x, y) ? 100.0 : 300.0; });
  const std::vector<double> large = enlarge_joint_bilateral(map, image, {1.0, 0.02});
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x) {
      EXPECT_NEAR(large[static_cast<std::size_t>(20 * y + x)], left(x, y) ? 1.0 : 3.0, 1e-9)
          << x << ", " << y;
    }
  }
}

TEST(Enlarger, APixelUnlikeEverySpotTakesTheNearest) {
  const SpotGrid grid = make_spot_grid(6, 1, 2, 1);
  const SmallMap map = map_of(grid, [](int x, int) { return x; });
  const IntensityImage image = image_of(grid, [](int x, int) { return x == 3 ? 1000.0 : 1.0; });
  EXPECT_EQ(enlarge_joint_bilateral(map, image, {0.5, 1e-3})[3], 4.0);
}

TEST(Enlarger, RefusesSizesAndWidthsThatDoNotFit) {
  const SpotGrid grid = make_spot_grid(6, 2, 2, 1);
  SmallMap map = map_of(grid, [](int, int) { return 1.0; });
  const IntensityImage image = image_of(grid, [](int, int) { return 1.0; });
  for (const JointBilateral widths : {JointBilateral{0.0, 1.0}, {1.0, 0.0}, {1.0, std::nan("")}}) {
    EXPECT_THAT([&] { (void)enlarge_joint_bilateral(map, image, widths); },
                ThrowsMessage<InputError>(HasSubstr("widths are above 0")));
  }
  const IntensityImage narrow{5, 2, std::vector<double>(10)};
  EXPECT_THAT(
      [&] { (void)enlarge_joint_bilateral(map, narrow, {}); },
      ThrowsMessage<InputError>(HasSubstr("5 x 2 pixels with 10 values cannot guide a map of 6 x 2")));
  map.confidence.pop_back();
  for (const auto& enlarge : {enlarge_nearest, enlarge_bilinear}) {
    EXPECT_THAT(
        [&] { (void)enlarge(map); },
        ThrowsMessage<InputError>(HasSubstr("2 x 1 pixels cannot have 2 distances and 1 confidences")));
  }
}

}  // namespace
}  // namespace dtof
