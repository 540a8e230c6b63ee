// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/target_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(TargetMap, IsAddressedByColumnAndRow) {
  TargetMap map(3, 2, {.depth_m = 1.0, .reflectivity = 0.5});
  map.at(2, 0).depth_m = 7.0;
  EXPECT_EQ(map.columns(), 3);
  EXPECT_EQ(map.rows(), 2);
  EXPECT_EQ(map.at(2, 0).depth_m, 7.0);
  EXPECT_EQ(map.at(0, 1), (PixelTarget{.depth_m = 1.0, .reflectivity = 0.5}));
  EXPECT_THAT([] { TargetMap(0, 2); }, ThrowsMessage<InputError>(HasSubstr("0 x 2")));
  EXPECT_THAT([] { TargetMap(2, -1); }, ThrowsMessage<InputError>(HasSubstr("2 x -1")));
}

}  // namespace
}  // namespace dtof
