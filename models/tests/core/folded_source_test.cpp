// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/folded_source.hpp"

#include <gmock/gmock.h>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

constexpr int kSensorColumns = 5;
constexpr int kSensorRows = 3;

/// Each pixel detects once, in the acquisition and with the code that name its place.
class PlaceSource final : public StreamSource {
 public:
  [[nodiscard]] int columns() const override { return kSensorColumns; }
  [[nodiscard]] int rows() const override { return kSensorRows; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return kSensorRows; }
  [[nodiscard]] ColumnStream column(int index) const override {
    ColumnStream stream;
    for (int row = 0; row < kSensorRows; ++row) {
      stream.append({static_cast<std::uint32_t>(row), static_cast<Timestamp>(10 * index + row)});
      stream.finish_row();
    }
    return stream;
  }
};

TEST(FoldedSource, HasTheSensorsColumnsOneAfterTheOther) {
  const PlaceSource sensor;
  const FoldedSource folded(sensor, 2);
  EXPECT_EQ(folded.columns(), 3);
  EXPECT_EQ(folded.rows(), 2 * kSensorRows);
  EXPECT_EQ(folded.acquisitions(), sensor.acquisitions());
  for (int column = 0; column < folded.columns(); ++column) {
    const ColumnStream stream = folded.column(column);
    ASSERT_EQ(stream.rows(), folded.rows());
    for (int row = 0; row < folded.rows(); ++row) {
      const int of_sensor = 2 * column + row / kSensorRows;
      if (of_sensor < kSensorColumns) {
        ASSERT_EQ(stream.row(row).size(), 1U);
        EXPECT_EQ(stream.row(row)[0].timestamp, 10 * of_sensor + row % kSensorRows);
      } else {
        EXPECT_TRUE(stream.row(row).empty()) << "there is no such column";
      }
    }
  }
}

TEST(FoldedSource, OfOneColumnIsTheSensor) {
  const PlaceSource sensor;
  const FoldedSource folded(sensor, 1);
  EXPECT_EQ(folded.columns(), kSensorColumns);
  EXPECT_EQ(folded.column(3), sensor.column(3));
}

TEST(FoldedSource, RefusesMoreColumnsThanTheSensorHas) {
  const PlaceSource sensor;
  EXPECT_EQ(FoldedSource(sensor, kSensorColumns).columns(), 1);
  EXPECT_THAT(
      [&] { FoldedSource(sensor, kSensorColumns + 1); },
      testing::ThrowsMessage<InputError>("6 columns for each SRAM, must be 1 to the sensor's 5 columns"));
  EXPECT_THROW(FoldedSource(sensor, 0), InputError);
}

}  // namespace
}  // namespace dtof
