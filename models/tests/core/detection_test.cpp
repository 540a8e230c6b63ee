// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/detection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

TEST(ColumnStream, StartsEmpty) {
  const ColumnStream stream;
  EXPECT_EQ(stream.rows(), 0);
  EXPECT_EQ(stream.detection_count(), 0U);
}

TEST(ColumnStream, RowsKeepTheirDetections) {
  ColumnStream stream;
  stream.append_row(std::vector<Detection>{{0, 5}, {0, 7}, {3, 1}});
  stream.append_row({});
  stream.append_row(std::vector<Detection>{{2, 9}});
  ASSERT_EQ(stream.rows(), 3);
  EXPECT_EQ(stream.detection_count(), 4U);
  EXPECT_THAT(stream.row(0), ElementsAre(Detection{0, 5}, Detection{0, 7}, Detection{3, 1}));
  EXPECT_THAT(stream.row(1), IsEmpty());
  EXPECT_THAT(stream.row(2), ElementsAre(Detection{2, 9}));
}

TEST(ColumnStream, FirstAcquisitionsAreDropped) {
  ColumnStream stream;
  stream.append_row(std::vector<Detection>{{0, 5}, {1, 7}, {2, 1}, {2, 3}, {4, 6}});
  stream.append_row(std::vector<Detection>{{1, 9}});
  const ColumnStream rest = without_first(stream, 2);
  ASSERT_EQ(rest.rows(), 2);
  EXPECT_THAT(rest.row(0), ElementsAre(Detection{0, 1}, Detection{0, 3}, Detection{2, 6}));
  EXPECT_THAT(rest.row(1), IsEmpty());
  EXPECT_EQ(without_first(stream, 0), stream);
}

TEST(ColumnStream, BuiltOneByOneIsTheSame) {
  ColumnStream whole;
  whole.append_row(std::vector<Detection>{{0, 5}, {1, 6}});
  whole.append_row({});
  ColumnStream pieces;
  pieces.append({0, 5});
  pieces.append({1, 6});
  EXPECT_EQ(pieces.rows(), 0);
  pieces.finish_row();
  pieces.finish_row();
  EXPECT_EQ(pieces, whole);
  pieces.finish_row();
  EXPECT_NE(pieces, whole);
}

TEST(ColumnStream, ClearRemovesRowsAndDetections) {
  ColumnStream stream;
  stream.append_row(std::vector<Detection>{{0, 5}});
  stream.clear();
  EXPECT_EQ(stream, ColumnStream());
  stream.append_row(std::vector<Detection>{{4, 2}});
  EXPECT_THAT(stream.row(0), ElementsAre(Detection{4, 2}));
}

/// Says it has more rows than it makes.
class ThreeRows final : public StreamSource {
 public:
  [[nodiscard]] int columns() const override { return 1; }
  [[nodiscard]] int rows() const override { return 4; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return 8; }
  [[nodiscard]] ColumnStream column(int /*index*/) const override {
    ColumnStream stream;
    stream.append_row(std::vector<Detection>{{0, 5}});
    stream.append_row({});
    stream.append_row(std::vector<Detection>{{1, 6}, {2, 9}});
    return stream;
  }
};

TEST(StreamSource, RowsOfAColumnAreItsOwn) {
  const ThreeRows source;
  const ColumnStream rows = source.column_rows(0, {.first = 1, .count = 2});
  ASSERT_EQ(rows.rows(), 2);
  EXPECT_THAT(rows.row(0), IsEmpty());
  EXPECT_THAT(rows.row(1), ElementsAre(Detection{1, 6}, Detection{2, 9}));
  EXPECT_EQ(source.column_rows(0, {.first = 0, .count = 3}), source.column(0));
  EXPECT_EQ(source.column_rows(0, {.first = 2, .count = 0}).rows(), 0);
}

TEST(StreamSource, RefusesAColumnThatLacksRows) {
  EXPECT_THAT([] { (void)ThreeRows().column_rows(0, {.first = 2, .count = 2}); },
              ThrowsMessage<InputError>(HasSubstr("column 0 has 3 rows, not 4")));
}

}  // namespace
}  // namespace dtof
