// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/point_cloud.hpp"

#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::EndsWith;

/// Two known pixels of four, with a confidence and an amplitude.
class PointCloudTest : public test::IoTest {
 protected:
  DepthImage image{.width = 2, .height = 2, .metres = {1.5F, 0.0F, std::nanf(""), 2.5F}};
  std::vector<PointField> fields = {{"confidence", {7.0F, 8.0F, 9.0F, 10.0F}},
                                    {"amplitude", {0.5F, 0.0F, 0.0F, 0.25F}}};

  /// The numbers of the two points, as they should stand in the file.
  [[nodiscard]] std::vector<float> expected() const {
    const Point first = point_of_pixel(image, 0, 0, 1.0);
    const Point second = point_of_pixel(image, 1, 1, 1.0);
    return {first.x, first.y, first.z, 7.0F, 0.5F, second.x, second.y, second.z, 10.0F, 0.25F};
  }
  /// Header and numbers of a file whose header ends with `last`.
  [[nodiscard]] std::pair<std::string, std::vector<float>> read(const std::string& last, bool text) const {
    const std::string file = contents(path("a"));
    const std::size_t data = file.find(last) + last.size();
    std::vector<float> numbers;
    if (text) {
      std::istringstream words(file.substr(data));
      for (float number = 0; words >> number;) {
        numbers.push_back(number);
      }
    } else {
      numbers.resize((file.size() - data) / sizeof(float));
      std::memcpy(numbers.data(), &file[data], numbers.size() * sizeof(float));
    }
    return {file.substr(0, data), numbers};
  }
};

TEST_F(PointCloudTest, PlyHasTheFieldsOfEachKnownPixel) {
  for (const bool text : {false, true}) {
    write_point_cloud(path("a"), image, fields, text ? PointCloudFormat::kPlyText : PointCloudFormat::kPly,
                      1.0);
    const auto [header, numbers] = read("end_header\n", text);
    EXPECT_EQ(header, std::string("ply\nformat ") + (text ? "ascii" : "binary_little_endian") +
                          " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
                          "property float confidence\nproperty float amplitude\nend_header\n");
    EXPECT_EQ(numbers, expected());
  }
}

TEST_F(PointCloudTest, PcdHasTheFieldsOfEachKnownPixel) {
  for (const bool text : {false, true}) {
    write_point_cloud(path("a"), image, fields, text ? PointCloudFormat::kPcdText : PointCloudFormat::kPcd,
                      1.0);
    const auto [header, numbers] = read(text ? "DATA ascii\n" : "DATA binary\n", text);
    EXPECT_EQ(header,
              std::string("# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
                          "FIELDS x y z confidence amplitude\nSIZE 4 4 4 4 4\nTYPE F F F F F\n"
                          "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ") +
                  (text ? "ascii\n" : "binary\n"));
    EXPECT_EQ(numbers, expected());
  }
}

TEST_F(PointCloudTest, Refusals) {
  test::expect_input_error(
      [&] { write_point_cloud(path("a"), image, fields, PointCloudFormat::kPcd, 90.0); },
      EndsWith("a: a point cloud of 2 x 2 pixels of 90 degrees each: its sides must be above 0 and below 180 "
               "degrees"));
  EXPECT_THROW(write_point_cloud(path("a"), image, std::vector<PointField>{{"short", {1.0F}}},
                                 PointCloudFormat::kPly, 1.0),
               std::logic_error);
  EXPECT_EQ(file_count(), 0U);
}

}  // namespace
}  // namespace dtof
