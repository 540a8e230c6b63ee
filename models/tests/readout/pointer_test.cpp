// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pointer.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "dtof/readout/model.hpp"
#include "dtof/readout/paired_his_pointer.hpp"

namespace dtof {
namespace {

ReadoutParameters ezpointer(int np) { return ReadoutParameters::defaults(Readout::kEzPointer, np); }

/// Four-bit pointer at `code` after `timestamp`.
std::uint32_t move(std::uint32_t code, std::uint32_t timestamp, std::uint32_t step = 1) {
  const PointerFormat format(ezpointer(4));
  const PointerWord word = format.word(code);
  return format.code(pointer_move(word, format.word(timestamp) - word, format.word(step)));
}

bool near(int np, std::uint32_t distance) {
  const PointerFormat format(ezpointer(np));
  return format.near(format.word(distance));
}

TEST(PointerMove, ThesisFigure37) {
  EXPECT_EQ(move(7, 11), 8U);
  EXPECT_EQ(move(8, 9), 9U);

  PointerBuilder pointer(ezpointer(4));
  pointer.start_frame({0, 3});
  const std::vector<Detection> row = {{0, 11}, {1, 9}, {2, 15}};
  PassCursor cursor(row, 15);
  EXPECT_EQ(pointer.follow(cursor, 7, {-1, 15}).code, 9U) << "15 is the no-detection code";
}

TEST(PointerMove, OppositePointCountsAsRight) {
  EXPECT_EQ(move(4, 12), 5U);
  EXPECT_EQ(move(4, 13), 3U);
  EXPECT_EQ(move(12, 4), 13U);
}

TEST(PointerMove, StaysOnItsOwnCodeAndWrapsAtBothEnds) {
  EXPECT_EQ(move(6, 6), 6U);
  EXPECT_EQ(move(15, 2), 0U);
  EXPECT_EQ(move(0, 14), 15U);
  EXPECT_EQ(move(14, 1, 5), 3U);
  EXPECT_EQ(move(1, 14, 5), 12U);
}

TEST(PointerNear, ASixteenthOfTheRangeAroundThePointer) {
  EXPECT_TRUE(near(10, 0));
  EXPECT_TRUE(near(10, 31));
  EXPECT_FALSE(near(10, 32));
  EXPECT_FALSE(near(10, 991));
  EXPECT_TRUE(near(10, 992));
  EXPECT_TRUE(near(10, 1023));
  EXPECT_TRUE(near(3, 0));
  EXPECT_FALSE(near(3, 1));
  EXPECT_TRUE(near(3, 7));
}

TEST(PointerBuilder, StepHalvesByGears) {
  ReadoutParameters parameters = ezpointer(4);
  parameters.fraction_bits = 2;
  PointerBuilder pointer(parameters);
  pointer.start_frame({0, 4});
  // Words in quarters from 32: full step twice, half a bin, then a quarter.
  const std::vector<Detection> row = {{0, 12}, {1, 12}, {2, 12}, {3, 12}};
  PassCursor cursor(row, 15);
  const PixelResult result = pointer.follow(cursor, 8, {-1, 15});
  EXPECT_EQ(result.code, 10U);
  EXPECT_EQ(result.fraction, 3U);  // 32 + 4 + 4 + 2 + 1 = 43
}

TEST(PointerBuilder, GearsCountFromTheMeasurementsBegin) {
  ReadoutParameters parameters = ezpointer(4);
  parameters.fraction_bits = 1;
  PointerBuilder pointer(parameters);
  pointer.start_frame({4, 8});
  const std::vector<Detection> row = {{5, 12}, {6, 12}};
  PassCursor cursor(row, 15);
  const PixelResult result = pointer.follow(cursor, 8, {-1, 15});
  EXPECT_EQ(result.code, 9U);
  EXPECT_EQ(result.fraction, 1U);
}

TEST(PointerBuilder, ConfidenceRisesNearTheTopAndFallsByOneFarTimestampInEight) {
  PointerBuilder pointer(ezpointer(10));
  const auto confidence_after = [&](const std::vector<Timestamp>& timestamps) {
    std::vector<Detection> row;
    row.reserve(timestamps.size());
    for (const Timestamp timestamp : timestamps) {
      row.push_back({static_cast<std::uint32_t>(row.size()), timestamp});
    }
    pointer.start_frame({0, static_cast<std::uint32_t>(row.size())});
    PassCursor cursor(row, 1023);
    return pointer.follow(cursor, 512, {-1, 1023}).confidence;
  };
  EXPECT_EQ(confidence_after({512, 512, 512}), 3U);
  EXPECT_EQ(confidence_after(std::vector<Timestamp>(100, 512)), 15U);
  EXPECT_EQ(confidence_after({512, 512, 801}), 2U) << "far, low bits not zero";
  EXPECT_EQ(confidence_after({512, 512, 800}), 1U) << "far, low bits zero";
  EXPECT_EQ(confidence_after({800, 800, 512}), 1U) << "does not fall below zero";
}

TEST(PointerBuilder, NoConfidenceBitsMeansZero) {
  ReadoutParameters parameters = ezpointer(4);
  parameters.confidence_width = 0;
  PointerBuilder pointer(parameters);
  pointer.start_frame({0, 2});
  const std::vector<Detection> row = {{0, 8}, {1, 8}};
  PassCursor cursor(row, 15);
  EXPECT_EQ(pointer.follow(cursor, 8, {-1, 15}).confidence, 0U);
}

TEST(PairedHisPointer, APulseOnABorderBeatsALoneBin) {
  const ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer);
  // Coarse bins of 32 codes: 5 counts in bin 20, 4 and 4 either side of code 320. Then the pulse only.
  ColumnStream column;
  std::uint32_t acquisition = 0;
  for (const auto& [code, count] :
       {std::pair(650, 5), std::pair(319, 4), std::pair(320, 4), std::pair(322, 13)}) {
    for (int i = 0; i < count; ++i) {
      column.append({acquisition++, static_cast<Timestamp>(code)});
    }
  }
  column.finish_row();
  EXPECT_EQ(make_paired_his_pointer(parameters)->run_column(column, 26).front().code, 322);
  // hisPointer starts in the middle of bin 20 and its window holds nothing of the pulse.
  EXPECT_EQ(make_readout_model(parameters)->run_column(column, 26).front().code, 656);
}

// Counts of coarse bins of 32 codes in measurement 1 and nothing in measurement 2: the code is the border in
// the middle of the best pair.
int best_pair_border(int count_width, const std::vector<std::pair<int, int>>& bins_and_counts) {
  ReadoutParameters parameters = ReadoutParameters::defaults(Readout::kHisPointer);
  parameters.count_width = count_width;
  ColumnStream column;
  std::uint32_t acquisition = 0;
  for (const auto& [bin, count] : bins_and_counts) {
    for (int i = 0; i < count; ++i) {
      column.append({acquisition++, static_cast<Timestamp>(32 * bin + 7)});
    }
  }
  column.finish_row();
  return make_paired_his_pointer(parameters)->run_column(column, 2 * acquisition).front().code / 32;
}

TEST(PairedHisPointer, TheLowestOfEqualPairsWins) {
  EXPECT_EQ(best_pair_border(10, {{3, 2}, {15, 2}}), 3);
  EXPECT_EQ(best_pair_border(10, {{3, 2}, {15, 3}}), 15);
}

TEST(PairedHisPointer, EveryPairMayWin) {
  for (int pair = 0; pair < 31; ++pair) {
    EXPECT_EQ(best_pair_border(10, {{pair, 2}, {pair + 1, 2}, {(pair + 16) % 32, 3}}), pair + 1);
  }
}

TEST(PairedHisPointer, CountsSaturate) {
  // Bin 20 stops at 3: less than the 4 of bins 25 and 26, and one count more would be a tie that it wins.
  EXPECT_EQ(best_pair_border(2, {{20, 7}, {25, 3}, {26, 1}}), 26);
  EXPECT_EQ(best_pair_border(3, {{20, 7}, {25, 3}, {26, 1}}), 20);
}

}  // namespace
}  // namespace dtof
