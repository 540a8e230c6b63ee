// SPDX-License-Identifier: Apache-2.0
#include "scoreboard/scoreboard.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

const std::vector<int> kColumns = {7, 9};
const std::vector<PixelResult> kExpected = {{1, 0, 3}, {2, 0, 3}, {3, 0, 3}, {4, 1, 3}};
const std::vector<std::uint64_t> kCycles = {100, 102, 200, 202};

TEST(CompareFrames, FindsNothingInEqualFrames) {
  EXPECT_THAT(compare_frames(kColumns, kExpected, kExpected, kCycles), IsEmpty());
}

TEST(CompareFrames, FindsEveryFieldWithItsPixelAndClock) {
  std::vector<PixelResult> actual = kExpected;
  actual[0].code = 8;
  actual[1].confidence = 0;
  actual[3].fraction = 0;
  EXPECT_THAT(
      compare_frames(kColumns, kExpected, actual, kCycles),
      ElementsAre(Mismatch{7, 0, {1, 0, 3}, {8, 0, 3}, 100}, Mismatch{9, 0, {2, 0, 3}, {2, 0, 0}, 102},
                  Mismatch{9, 1, {4, 1, 3}, {4, 0, 3}, 202}));
}

TEST(CompareFrames, RefusesFramesOfDifferentShape) {
  const std::vector<PixelResult> shorter(kExpected.begin(), kExpected.end() - 1);
  EXPECT_THAT([&] { compare_frames(kColumns, kExpected, shorter, kCycles); },
              ThrowsMessage<InputError>(HasSubstr("frames of 4 and 3 results")));
  EXPECT_THAT([&] { compare_frames(kColumns, shorter, shorter, kCycles); },
              ThrowsMessage<InputError>(HasSubstr("2 columns do not compare")));
}

TEST(DescribeMismatches, SaysEverythingNeededToFindTheFault) {
  std::vector<Mismatch> mismatches;
  mismatches.reserve(8);
  for (int row = 0; row < 8; ++row) {
    mismatches.push_back(
        {.column = 12, .row = row, .expected = {511, 2, 9}, .actual = {512, 0, 1}, .cycle = 4000});
  }
  const FrameContext context = {
      .configuration = {.parameters = ReadoutParameters::defaults(Readout::kHisPointer)},
      .acquisitions = 3333,
      .seed = 42,
      .reproduce = "dtof frame --seed 42 --columns 12 --trace wave.fst",
      .shortest_failing_frame = 17};
  const std::string text = describe_mismatches(mismatches, 1280, context);
  for (const char* part : {"8 of 1280 pixels differ", "hispointer NP=10 SLOTS=2 NB=5", "GUARD=46",
                           "PIXELS_PER_SRAM=160", "3333 acquisitions", "seed 42", "cut to 17 acquisitions",
                           "column 12 row 0: expected code 511 fraction 2 confidence 9, ",
                           "actual code 512 fraction 0 confidence 1, clock 4000", "row 4",
                           "dtof frame --seed 42 --columns 12 --trace wave.fst"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(text, Not(HasSubstr("row 5"))) << "only the first few";
}

}  // namespace
}  // namespace dtof
