// SPDX-License-Identifier: Apache-2.0
#include "core/detection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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

TEST(ColumnStream, ClearForgetsRowsAndDetections) {
  ColumnStream stream;
  stream.append_row(std::vector<Detection>{{0, 5}});
  stream.clear();
  EXPECT_EQ(stream, ColumnStream());
  stream.append_row(std::vector<Detection>{{4, 2}});
  EXPECT_THAT(stream.row(0), ElementsAre(Detection{4, 2}));
}

}  // namespace
}  // namespace dtof
