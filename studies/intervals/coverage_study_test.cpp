// SPDX-License-Identifier: Apache-2.0
#include "intervals/coverage_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "intervals/coverage_report.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

CoverageSettings small_coverage_study() {
  CoverageSettings settings;
  settings.study.sensor = parse_preset("thesis");
  settings.study.readouts = {ReadoutParameters::defaults(Readout::kEzPointer),
                             ReadoutParameters::defaults(Readout::kHisPointer)};
  settings.study.matched_filter = false;
  settings.study.calibration_frames = 60;
  settings.study.run.seed = test_seed();
  settings.study.distances_m = {1.0};
  settings.klux = {14.0};
  settings.distances_m = {1.0};
  settings.frames = {100, 1000};
  settings.precisions = {0.1};
  settings.other_calibrations = 2;
  return settings;
}

const CoverageCell& cell_of(const CoverageStudy& study, const std::string& estimator, Figure figure,
                            bool after_table, int frames) {
  return *std::ranges::find_if(study.cells, [&](const CoverageCell& cell) {
    return cell.estimator == estimator && cell.figure == figure && cell.after_table == after_table &&
           cell.frames == frames;
  });
}

TEST(CoverageStudy, IntervalsHoldWithTheNamedTable) {
  SCOPED_TRACE(test_seed_message());
  const CoverageSettings settings = small_coverage_study();
  const CoverageStudy study = run_coverage_study(settings);
  EXPECT_EQ(study.cells.size(), 2U * 2U * 2U * 5U);  // read-outs, frame counts, states, figures
  for (const CoverageCell& cell : study.cells) {
    EXPECT_NE(cell.verdict, CoverageVerdict::kFails)
        << cell.title << ", " << figure_name(cell.figure) << ", " << cell.frames << " frames: ratio "
        << cell.seen.spread_ratio() << ", " << cell.seen.covered << " of " << cell.seen.runs;
    EXPECT_EQ(cell.seen.runs, cell.frames == 100 ? 400U : 40U);
  }
  for (const StoppingCell& cell : study.stopping) {
    EXPECT_TRUE(cell.holds()) << cell.title;
  }
  EXPECT_EQ(coverage_failures(study), 0U);
}

// The fault that the study is there to find: a table for each seed, and intervals that do not know of it.
TEST(CoverageStudy, ATableForEachSeedFails) {
  SCOPED_TRACE(test_seed_message());
  CoverageSettings settings = small_coverage_study();
  settings.calibrate_each_seed = true;
  const CoverageStudy study = run_coverage_study(settings);
  for (const char* estimator : {"ezpointer", "hispointer"}) {
    EXPECT_GT(cell_of(study, estimator, Figure::kRmse, true, 1000).seen.spread_ratio(), kMostSpreadRatio);
    EXPECT_GT(cell_of(study, estimator, Figure::kAbove3Percent, true, 1000).seen.spread_ratio(),
              kMostSpreadRatio);
    EXPECT_LT(cell_of(study, estimator, Figure::kBias, false, 100).seen.spread_ratio(), kMostSpreadRatio);
  }
  EXPECT_GT(coverage_failures(study), 0U);
}

TEST(CoverageStudy, Refusals) {
  CoverageSettings settings = small_coverage_study();
  settings.frames = {300, 1000};
  EXPECT_THAT([&] { (void)run_coverage_study(settings); },
              ThrowsMessage<InputError>(HasSubstr("a divisor of 1000")));
  settings = small_coverage_study();
  settings.seeds = 1;
  EXPECT_THAT([&] { (void)run_coverage_study(settings); }, ThrowsMessage<InputError>(HasSubstr("two seeds")));
}

TEST(CoversEnough, OnlyWhereFewerAreRefuted) {
  EXPECT_TRUE(covers_enough(40, 40));
  EXPECT_TRUE(covers_enough(35, 40));
  EXPECT_FALSE(covers_enough(34, 40));
  EXPECT_FALSE(covers_enough(3740, 4000));
}

CoverageCell cell_with(double spread, std::uint64_t covered, bool by_spread, CoverageVerdict verdict) {
  CoverageCell cell;
  cell.estimator = "ezpointer";
  cell.title = "ezPointer";
  cell.klux = 14.0;
  cell.distance_m = 1.0;
  cell.frames = 1000;
  cell.seen = {.runs = 40, .covered = covered, .with_few = 0, .spread = spread, .mean_standard_error = 1.0};
  cell.by_spread = by_spread;
  cell.verdict = verdict;
  return cell;
}

TEST(CoverageReport, SentencesFollowTheFigures) {
  CoverageSettings settings = small_coverage_study();
  settings.frames = {1000};
  CoverageStudy study;
  for (const bool after : {false, true}) {
    for (const Figure figure : kFigures) {
      CoverageCell cell = cell_with(1.01, 38, true, CoverageVerdict::kHolds);
      cell.figure = figure;
      cell.after_table = after;
      study.cells.push_back(cell);
    }
  }
  StoppingCell stopping;
  stopping.title = "ezPointer";
  stopping.precision = 0.1;
  stopping.seeds = stopping.reached = stopping.precision_right = stopping.rmse_right = 40;
  study.stopping = {stopping};
  const auto page = [&] {
    return page_text("coverage_study", coverage_page(settings, study, "dtof-study coverage"));
  };
  const std::string good = page();
  EXPECT_THAT(good, HasSubstr("**10 of 10 cells hold.**"));
  EXPECT_THAT(good, HasSubstr("10 of these lie from 0.8 to 1.25 at once"));
  EXPECT_THAT(
      good,
      HasSubstr("|\n\nNo cell lies outside.\n\n## Is the error within --precision when a run stops?\n"));
  EXPECT_THAT(good, HasSubstr("|\n\n0 of 1 fail.\n\nCommand: `dtof-study coverage`\n"));

  study.cells[3].seen.spread = 2.5;
  study.cells[3].verdict = CoverageVerdict::kFails;
  study.cells[4].by_spread = false;
  study.stopping[0].rmse_right = 20;
  const std::string bad = page();
  EXPECT_THAT(
      bad,
      HasSubstr(
          "**9 of 10 cells hold.** Judged by the spread: 9; 8 of these lie from 0.8 to 1.25 at once, 0 "
          "after runs were drawn again.\nJudged by the share of intervals that contain the truth: 1; 1 of "
          "these hold at once, 0 after runs were drawn again.\n\nExtremes "));
  EXPECT_THAT(bad, HasSubstr("|\n\nCells that lie outside with the seeds' own runs:\n\n| read-out "));
  EXPECT_THAT(bad, HasSubstr("|\n\n1 of 1 fail:\n\n| read-out "));
  EXPECT_THAT(bad, HasSubstr("**9 of 10 cells hold.**"));
  EXPECT_THAT(bad, HasSubstr("8 of these lie from 0.8 to 1.25 at once"));
  EXPECT_THAT(bad, HasSubstr("Judged by the share of intervals that contain the truth: 1;"));
  EXPECT_THAT(bad, Not(HasSubstr("No cell lies outside.")));
  EXPECT_THAT(bad, HasSubstr("above 3 % before the table"));
  EXPECT_THAT(bad, HasSubstr("1 of 1 fail:"));
  EXPECT_EQ(coverage_failures(study), 2U);
}

TEST(CoverageReport, SaysHowItWasMeasured) {
  CoverageSettings settings = small_coverage_study();
  settings.study.run.seed = 5;
  CoverageStudy study;
  for (const bool after : {false, true}) {
    for (const Figure figure : kFigures) {
      for (const int frames : settings.frames) {
        CoverageCell cell = cell_with(1.01, 38, true, CoverageVerdict::kHolds);
        cell.figure = figure;
        cell.after_table = after;
        cell.frames = frames;
        study.cells.push_back(cell);
      }
    }
  }
  TableSpread spread;
  spread.title = "ezPointer";
  spread.deviation = 0.5;
  spread.standard_error = 1.0;
  spread.frames = 1000;
  study.tables = {spread};
  const std::string page = page_text("coverage_study", coverage_page(settings, study, "dtof-study coverage"));
  EXPECT_THAT(
      page,
      HasSubstr("agree with repeated runs? 40 seeds from 5 on, 1000 frames each, at 14 klux and 1 m. All "
                "read-outs see the same photons. Shorter runs are parts of the long ones (400 runs of 100 "
                "frames). Preset thesis, calibration run 1. The truth is the figure over all 40000 "
                "frames.\n\nA cell is one figure of one read-out at one place with one number of frames. A "
                "cell holds if the spread of the figure over runs is 0.8 to 1.25 times the mean of the "
                "reported standard errors (about a quarter of the interval's width). 40 runs leave this "
                "ratio uncertain by about 11 %. If their ratio lies outside, 4000 runs drawn with "
                "replacement from all frames decide. "));
  EXPECT_THAT(
      page,
      HasSubstr("\n\nThe figures of each seed are judged after 100, twice, four times as many frames and so "
                "on, up to 1000. A run stops when "));
  EXPECT_THAT(page, HasSubstr("outliers are rarer than 0.1 %; the figures are then those without outliers."));
  EXPECT_THAT(
      page,
      HasSubstr("\n\n## What another calibration run would change\n\nAll figures after the table are from "
                "calibration run 1: 60 frames at every 0.05 m. Here the tables of 2 other runs correct "
                "the same frames. The table shows the spread of the figures over these tables, in "
                "standard errors reported with 1000 frames. The intervals do not include this spread: "
                "they are for one calibrated sensor.\n\n| median over places (largest) "));
  EXPECT_THAT(page, HasSubstr("| 0.50 (0.50) |"));
}

}  // namespace
}  // namespace dtof
