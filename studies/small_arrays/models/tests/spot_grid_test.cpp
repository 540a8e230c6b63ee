// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/spot_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(SpotGrid, AnArrayOfTheSameSizeHasEverySpot) {
  const SpotGrid grid = make_spot_grid(4, 3, 4, 3);
  EXPECT_THAT(grid.x, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(grid.y, ElementsAre(0, 1, 2));
}

TEST(SpotGrid, SpotsAreInTheMiddleOfTheirShare) {
  EXPECT_THAT(make_spot_grid(9, 8, 3, 2).x, ElementsAre(1, 4, 7));
  EXPECT_THAT(make_spot_grid(9, 8, 3, 2).y, ElementsAre(2, 6));
  const SpotGrid uneven = make_spot_grid(200, 160, 80, 64);
  for (std::size_t i = 0; i < uneven.x.size(); ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * 2.5;
    EXPECT_LE(uneven.x[i], middle);
    EXPECT_GT(uneven.x[i] + 1, middle);
  }
}

TEST(SpotGrid, RefusesArraysThatAreNotSmall) {
  for (const auto& [columns, rows] : {std::pair{5, 3}, {4, 4}, {0, 3}, {4, -1}}) {
    EXPECT_THAT([&] { (void)make_spot_grid(4, 3, columns, rows); },
                ThrowsMessage<InputError>(HasSubstr("a small array has 1 to 4 columns and 1 to 3 rows")));
  }
}

TEST(SpotGrid, SpotsOfAMapAreItsPixels) {
  TargetMap map(9, 8);
  for (int column = 0; column < 9; ++column) {
    for (int row = 0; row < 8; ++row) {
      map.at(column, row) = {column + 1.0, 0.1 * (row + 1)};
    }
  }
  const TargetMap spots = spots_of(map, make_spot_grid(9, 8, 3, 2));
  ASSERT_EQ(spots.columns(), 3);
  ASSERT_EQ(spots.rows(), 2);
  EXPECT_EQ(spots.at(2, 1).depth_m, 8.0);
  EXPECT_DOUBLE_EQ(spots.at(2, 1).reflectivity, 0.7);
  EXPECT_EQ(spots.at(0, 0).depth_m, 2.0);
  EXPECT_THAT([&] { (void)spots_of(map, make_spot_grid(8, 8, 3, 2)); },
              ThrowsMessage<InputError>(HasSubstr("the map has 9 x 8 pixels, the large array 8 x 8")));
}

TEST(SpotGrid, TheNearestSpotIsThatOfASearchOfAll) {
  const std::vector<int> spots = {1, 3, 4, 9};
  for (int coordinate = 0; coordinate < 12; ++coordinate) {
    int nearest = 0;
    for (int i = 1; i < 4; ++i) {
      const auto away = [&](int spot) {
        return std::abs(coordinate - spots[static_cast<std::size_t>(spot)]);
      };
      nearest = away(i) < away(nearest) ? i : nearest;
    }
    EXPECT_EQ(nearest_spot(spots, coordinate), nearest) << coordinate;
  }
}

}  // namespace
}  // namespace dtof
