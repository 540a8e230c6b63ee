// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<FaultCaseResult> harmless() {
  FaultCaseResult flips;
  flips.fault = {Readout::kPoolPointer, FaultKind::kFlippedBit, SramKind::kPoolQuad, std::nullopt};
  flips.frames = flips.next_frames = 3;
  flips.effects.push_back({.pixels = 64, .changed = 4, .moved = 3, .beyond = 2, .largest_m = 0.5});
  flips.effects.push_back({.pixels = 64, .changed = 0, .moved = 0, .beyond = 0, .largest_m = 0.0});
  FaultCaseResult hot;
  hot.fault = {Readout::kPoolPointer, FaultKind::kHotPixelFixedCode, std::nullopt, std::nullopt};
  hot.frames = hot.next_frames = 2;
  hot.effects.push_back({.pixels = 63, .changed = 9, .moved = 8, .beyond = 5, .largest_m = 1.0});
  return {flips, hot};
}

std::string page_of(const std::vector<FaultCaseResult>& results) {
  return page_text("faults", report_faults(results, {}, "test").page);
}

TEST(FaultReport, StatesWhatTheFiguresSay) {
  const std::string page = page_of(harmless());
  EXPECT_TRUE(faults_stay_where_they_are(harmless()));
  EXPECT_THAT(page, HasSubstr("every one was right in every pixel (5)"));
  EXPECT_THAT(page, HasSubstr("No fault changed a pixel of a column that it does not touch."));
  EXPECT_THAT(
      page, HasSubstr("1 of 2 flipped bits moved a depth, 1 beyond 3 %; the most pixels that one moved: 3"));
  EXPECT_THAT(page, HasSubstr("changed 9 others on average and spoilt 5, at most 5"));
  EXPECT_THAT(report_faults(harmless(), {}, "test").csv,
              HasSubstr("poolpointer,flipped_bit,four columns,-,3,0,0,2,128,1,1,1,500,500,500"));
}

TEST(FaultReport, SaysWhatWentWrong) {
  std::vector<FaultCaseResult> results = harmless();
  results[0].wrong_next_frames = 1;
  EXPECT_FALSE(faults_stay_where_they_are(results));
  EXPECT_THAT(page_of(results), HasSubstr("Frames after a fault: 1 of 5 were wrong."));

  results = harmless();
  results[1].changed_elsewhere = 7;
  EXPECT_FALSE(faults_stay_where_they_are(results));
  EXPECT_THAT(page_of(results), HasSubstr("7 pixels changed in columns that no fault touches."));

  results = harmless();
  results[1].broken_frames = 1;
  EXPECT_FALSE(faults_stay_where_they_are(results));
  EXPECT_THAT(page_of(results), HasSubstr("1 of 5 did not end"));

  results = harmless();
  results[1].model_mismatches = 2;
  EXPECT_FALSE(faults_stay_where_they_are(results));
  EXPECT_THAT(page_of(results), Not(HasSubstr("the array read what its model reads")));
}

}  // namespace
}  // namespace dtof
