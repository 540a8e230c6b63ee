// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/row_region.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/pixel_sampler.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

ColumnStream numbered_rows(int column, RowRange rows) {
  ColumnStream stream;
  for (int row = rows.first; row < rows.first + rows.count; ++row) {
    stream.append_row(std::vector<Detection>{{7, static_cast<Timestamp>(100 * column + row)}});
  }
  return stream;
}

/// 3 x 10 pixels; a pixel's one timestamp names it.
template <typename Source>
class Numbered : public Source {
 public:
  [[nodiscard]] int columns() const override { return 3; }
  [[nodiscard]] int rows() const override { return 10; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return 8; }
  [[nodiscard]] ColumnStream column(int index) const override { return numbered_rows(index, {0, rows()}); }
};

using NumberedSource = Numbered<StreamSource>;

/// Fails the test when a whole column is made.
class RowsOnlySource final : public NumberedSource {
 public:
  [[nodiscard]] ColumnStream column(int index) const override {
    ADD_FAILURE() << "a row that is off was asked for";
    return NumberedSource::column(index);
  }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange rows) const override {
    return numbered_rows(index, rows);
  }
};

/// Draws the pixel's column and row, and what it was asked for.
class EchoSampler final : public PixelSampler {
 public:
  void start_pixel(int column, int row) override {
    codes_ = {static_cast<Timestamp>(column), static_cast<Timestamp>(row)};
  }
  std::span<const Timestamp> draw(std::uint32_t acquisitions, std::int32_t first,
                                  std::int32_t last) override {
    codes_.push_back(static_cast<Timestamp>(acquisitions));
    codes_.push_back(static_cast<Timestamp>(first));
    codes_.push_back(static_cast<Timestamp>(last));
    return codes_;
  }

 private:
  std::vector<Timestamp> codes_;
};

class EchoSource final : public Numbered<SampledSource> {
 public:
  [[nodiscard]] std::unique_ptr<PixelSampler> pixel_sampler() const override {
    return std::make_unique<EchoSampler>();
  }
};

TEST(RowRegion, PixelsKeepTheirDetections) {
  const NumberedSource source;
  const auto region = row_region(source, {.first = 4, .count = 3});
  EXPECT_EQ(region->columns(), 3);
  EXPECT_EQ(region->rows(), 3);
  EXPECT_EQ(region->acquisitions(), 8U);
  const ColumnStream stream = region->column(2);
  ASSERT_EQ(stream.rows(), 3);
  EXPECT_THAT(stream.row(0), ElementsAre(Detection{7, 204}));
  EXPECT_THAT(stream.row(2), ElementsAre(Detection{7, 206}));
  EXPECT_EQ(dynamic_cast<const SampledSource*>(region.get()), nullptr);
}

TEST(RowRegion, OtherRowsAreNotMade) {
  const RowsOnlySource source;
  EXPECT_EQ(row_region(source, {.first = 4, .count = 3})->column(1), numbered_rows(1, {4, 3}));
}

TEST(RowRegion, RegionsNest) {
  const RowsOnlySource source;
  const auto outer = row_region(source, {.first = 4, .count = 5});
  const auto inner = row_region(*outer, {.first = 1, .count = 2});
  EXPECT_EQ(inner->column(0), numbered_rows(0, {5, 2}));
  EXPECT_EQ(outer->column_rows(0, {.first = 1, .count = 2}), numbered_rows(0, {5, 2}));
}

TEST(RowRegion, ASampledSourceStaysOne) {
  const EchoSource source;
  const auto region = row_region(source, {.first = 4, .count = 3});
  const auto* sampled = dynamic_cast<const SampledSource*>(region.get());
  ASSERT_NE(sampled, nullptr);
  const auto sampler = sampled->pixel_sampler();
  sampler->start_pixel(1, 2);
  EXPECT_THAT(sampler->draw(5, 16, 32), ElementsAre(1, 6, 5, 16, 32));
}

TEST(RowRegion, RefusesRowsThatTheSourceDoesNotHave) {
  const NumberedSource source;
  EXPECT_EQ(row_region(source, {.first = 0, .count = 10})->column(0), source.column(0));
  for (const RowRange rows :
       {RowRange{0, 11}, RowRange{9, 2}, RowRange{10, 1}, RowRange{-1, 2}, RowRange{3, 0}, RowRange{3, -1}}) {
    EXPECT_THAT([&] { (void)row_region(source, rows); }, ThrowsMessage<InputError>(HasSubstr("0 to 9")))
        << rows.first << " " << rows.count;
  }
}

TEST(DarkExcept, LitRowsKeepTheirPlaceAndTheOthersAreDark) {
  const RowsOnlySource source;
  const auto array = dark_except(source, {.first = 4, .count = 3}, 12);
  EXPECT_EQ(array->columns(), 3);
  EXPECT_EQ(array->rows(), 12);
  EXPECT_EQ(array->acquisitions(), 8U);
  const ColumnStream stream = array->column(2);
  ASSERT_EQ(stream.rows(), 12);
  for (int row = 0; row < 12; ++row) {
    if (row < 4 || row > 6) {
      EXPECT_TRUE(stream.row(row).empty()) << row;
    } else {
      EXPECT_THAT(stream.row(row), ElementsAre(Detection{7, static_cast<Timestamp>(200 + row)}));
    }
  }
}

TEST(DarkExcept, RefusesRowsThatSourceOrArrayDoNotHave) {
  const NumberedSource source;
  EXPECT_EQ(dark_except(source, {.first = 0, .count = 10}, 10)->column(0), source.column(0));
  EXPECT_THROW((void)dark_except(source, {.first = 9, .count = 2}, 20), InputError);
  EXPECT_THROW((void)dark_except(source, {.first = 4, .count = 3}, 6), InputError);
  EXPECT_THROW((void)dark_except(source, {.first = 4, .count = 0}, 20), InputError);
}

}  // namespace
}  // namespace dtof
