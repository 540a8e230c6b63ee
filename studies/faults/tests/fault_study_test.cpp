// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_study.hpp"

#include <gtest/gtest.h>

#include "dtof/core/error.hpp"
#include "faults/array_srams.hpp"
#include "faults/fault_report.hpp"

namespace dtof {
namespace {

FaultStudyOptions small_study(std::vector<Readout> readouts) {
  FaultStudyOptions options;
  options.readouts = std::move(readouts);
  options.acquisitions = 24;
  options.flips = 12;
  return options;
}

// Every read-out, every kind of fault and state: the frame after is right, other columns are untouched.
TEST(FaultStudy, FaultsStayWhereTheyAre) {
  const FaultStudyOptions options = small_study({kRtlReadouts.begin(), kRtlReadouts.end()});
  const std::vector<FaultCaseResult> results = study_faults(options);
  EXPECT_TRUE(faults_stay_where_they_are(results))
      << page_text("faults", report_faults(results, options, "test").page);
  for (const FaultCaseResult& result : results) {
    EXPECT_GT(result.frames, 0);
    EXPECT_EQ(result.next_frames, result.frames);
    if (result.fault.kind != FaultKind::kReset) {
      EXPECT_FALSE(result.effects.empty());
    }
  }
}

TEST(FaultStudy, AnSramAcrossABorderAffectsBothEngines) {
  EXPECT_EQ(affected_columns({4, 4}, 6, 12), (ColumnRange{0, 12}));
  EXPECT_EQ(affected_columns({0, 4}, 6, 12), (ColumnRange{0, 6}));
  EXPECT_EQ(affected_columns({8, 4}, 6, 12), (ColumnRange{6, 6}));
  EXPECT_EQ(affected_columns({8, 2}, 8, 10), (ColumnRange{8, 2}));
  EXPECT_EQ(affected_columns({5, 1}, 1, 12), (ColumnRange{5, 1}));
}

TEST(FaultStudy, StuckTimestampsAreSeenInTheirColumn) {
  const std::vector<FaultCaseResult> results = study_faults(small_study({Readout::kHistogram}));
  for (const FaultCaseResult& result : results) {
    if (result.fault.kind == FaultKind::kStuckTimestamps) {
      for (const FaultEffect& effect : result.effects) {
        EXPECT_EQ(effect.pixels, kFaultRows);
        EXPECT_EQ(effect.changed, kFaultRows);
      }
      return;
    }
  }
  FAIL() << "no column with stuck timestamps was tried";
}

TEST(FaultStudy, ThreadsDoNotChangeTheReport) {
  FaultStudyOptions options = small_study({Readout::kEzPointer});
  options.threads = 1;
  const std::string one = report_faults(study_faults(options), options, "test").csv;
  options.threads = 3;
  EXPECT_EQ(report_faults(study_faults(options), options, "test").csv, one);
}

TEST(FaultStudy, RefusesAStudyWithoutFlips) {
  FaultStudyOptions options = small_study({Readout::kEzPointer});
  options.flips = 0;
  EXPECT_THROW((void)study_faults(options), InputError);
  options.flips = 1;
  options.acquisitions = 0;
  EXPECT_THROW((void)study_faults(options), InputError);
}

}  // namespace
}  // namespace dtof
