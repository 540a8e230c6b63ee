// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/ply.hpp"

#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::EndsWith;
using ::testing::StartsWith;

class PlyTest : public test::IoTest {};

TEST_F(PlyTest, PointsLieAtTheMeasuredRange) {
  const DepthImage image{.width = 3, .height = 3, .metres = std::vector<float>(9, 2.0F)};
  const Point middle = point_of_pixel(image, 1, 1);
  EXPECT_FLOAT_EQ(middle.x, 0.0F);
  EXPECT_FLOAT_EQ(middle.y, 0.0F);
  EXPECT_FLOAT_EQ(middle.z, 2.0F);
  const Point corner = point_of_pixel(image, 2, 0);
  EXPECT_NEAR(std::hypot(corner.x, corner.y, corner.z), 2.0, 1e-6);
  EXPECT_NEAR(std::atan2(corner.x, corner.z) * 180.0 / std::numbers::pi, 0.48, 1e-5);
  EXPECT_LT(corner.y, 0.0F);
}

TEST_F(PlyTest, WritesOnlyKnownPixels) {
  const DepthImage image{.width = 3, .height = 1, .metres = {1.0F, 0.0F, std::nanf("")}};
  write_ply(path("a.ply"), image, {.lowest = 1.0, .highest = 2.0});
  const std::string file = contents(path("a.ply"));
  EXPECT_THAT(file, StartsWith("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"));
  const std::size_t data = file.find("end_header\n") + 11;
  ASSERT_EQ(file.size() - data, 15U);
  Point point{};
  std::memcpy(&point, &file[data], sizeof point);
  EXPECT_FLOAT_EQ(point.x, point_of_pixel(image, 0, 0).x);
  EXPECT_FLOAT_EQ(point.z, point_of_pixel(image, 0, 0).z);
  EXPECT_NEAR(static_cast<unsigned char>(file[data + 12]), 0x44, 5);  // viridis at 0
}

TEST_F(PlyTest, Refusals) {
  const DepthImage image{.width = 400, .height = 1, .metres = std::vector<float>(400, 1.0F)};
  test::expect_input_error(
      [&] { write_ply(path("a.ply"), image, {}); },
      EndsWith("400 x 1 pixels of 0.48 degrees each: its sides must be above 0 and below 180 degrees"));
  EXPECT_THAT(ply_obstacle(400, 1), StartsWith("a point cloud of 400 x 1 pixels"));
  EXPECT_EQ(ply_obstacle(400, 1, 0.1), "");
  test::expect_input_error([&] { write_ply(path("none/a.ply"), image, {}, 0.1); },
                           EndsWith("cannot write: No such file or directory"));
  EXPECT_EQ(file_count(), 0U);
}

}  // namespace
}  // namespace dtof
