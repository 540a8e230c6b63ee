// SPDX-License-Identifier: Apache-2.0
#include "dynamic_range/dynamic_range.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/sensor/preset.hpp"
#include "dynamic_range/dynamic_range_report.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// Two seeds of 1,000 pixels.
std::vector<RangeCounts> seeds(std::uint64_t above_3, std::uint64_t above_10 = 0) {
  const RangeCounts counts = {.pixels = 1000, .above_3_percent = above_3, .above_10_percent = above_10};
  return {counts, counts};
}

class DynamicRangeTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("dtof_range_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] RangeSettings small_study() const {
    RangeSettings settings;
    settings.sensor = parse_preset("thesis");
    settings.readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram)};
    settings.acquisitions = {100, 3000};
    settings.klux = {2.0};
    settings.signals = {1.0};
    settings.scenes = {Scene::kRoom};
    settings.rows = 8;
    settings.seeds = 2;
    settings.store = folder_;
    return settings;
  }

  std::filesystem::path folder_;
};

TEST(DynamicRangeLists, ListsACellThatMoreAcquisitionsMadeWorse) {
  RangeResults results;
  results[{1.0, 14.0, 100}]["poolpointer"] = seeds(500);
  results[{1.0, 14.0, 1000}]["poolpointer"] = seeds(10);
  results[{1.0, 14.0, 10'000}]["poolpointer"] = seeds(12);
  results[{1.0, 14.0, 33'333}]["poolpointer"] = seeds(300, 40);
  results[{1.0, 50.0, 65'535}]["poolpointer"] = seeds(900, 900);   // nothing to compare with
  results[{10.0, 14.0, 65'535}]["poolpointer"] = seeds(900, 900);  // another signal
  const std::vector<RangeFinding> findings = worse_with_more(results, Grown::kAcquisitions);
  ASSERT_EQ(findings.size(), 2U) << "12 in 1,000 is no worse than 10, beyond the intervals";
  EXPECT_EQ(findings[0].limit_percent, 3);
  EXPECT_EQ(findings[0].cell.acquisitions, 33'333U);
  EXPECT_EQ(findings[0].better_cell.acquisitions, 1000U) << "the best, not the nearest";
  EXPECT_DOUBLE_EQ(findings[0].share.value, 0.3);
  EXPECT_DOUBLE_EQ(findings[0].better_share.value, 0.01);
  EXPECT_EQ(findings[1].limit_percent, 10);
  EXPECT_EQ(findings[1].cell.acquisitions, 33'333U);
  EXPECT_TRUE(worse_with_more(results, Grown::kSignal).empty());
}

TEST(DynamicRangeLists, ListsACellThatMoreSignalMadeWorse) {
  RangeResults results;
  results[{0.1, 14.0, 1000}]["sifh"] = seeds(100);
  results[{1.0, 14.0, 1000}]["sifh"] = seeds(20);
  results[{10.0, 14.0, 1000}]["sifh"] = seeds(60);
  results[{10.0, 14.0, 3333}]["sifh"] = seeds(300);
  const std::vector<RangeFinding> findings = worse_with_more(results, Grown::kSignal);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].cell, (RangeCell{10.0, 14.0, 1000}));
  EXPECT_EQ(findings[0].better_cell, (RangeCell{1.0, 14.0, 1000}));
  EXPECT_FALSE(about_pool_readout(findings[0]));
}

TEST(DynamicRangeLists, ComparesPoolReadoutsWithTheCoarseHistogramInLongFrames) {
  RangeResults results;
  for (const std::uint32_t acquisitions : {3333U, 33'333U}) {
    RangeReadouts& readouts = results[{1.0, 14.0, acquisitions}];
    readouts["coarsehistogram"] = seeds(10, 5);
    readouts["poolpointer"] = seeds(100, 6);
    readouts["poolpointer-lean"] = seeds(11, 5);
    readouts["ezpointer"] = seeds(500, 500);
  }
  const std::vector<RangeFinding> findings = behind_coarse_histogram(results, kManyAcquisitions);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].readout, "poolpointer");
  EXPECT_EQ(findings[0].better_readout, "coarsehistogram");
  EXPECT_EQ(findings[0].limit_percent, 3);
  EXPECT_EQ(findings[0].cell.acquisitions, 33'333U);
  EXPECT_TRUE(about_pool_readout(findings[0]));
}

TEST(DynamicRangeLists, KeepsWhatOtherPhotonsShowAgain) {
  RangeResults results;
  for (const double klux : {2.0, 14.0}) {
    results[{1.0, klux, 1000}]["poolpointer"] = seeds(10);
    results[{1.0, klux, 10'000}]["poolpointer"] = seeds(100);
  }
  const std::vector<RangeFinding> findings = worse_with_more(results, Grown::kAcquisitions);
  ASSERT_EQ(findings.size(), 2U);
  RangeResults again;
  again[{1.0, 2.0, 1000, 1}]["poolpointer"] = seeds(10);
  again[{1.0, 2.0, 10'000, 1}]["poolpointer"] = seeds(90);
  again[{1.0, 14.0, 1000, 1}]["poolpointer"] = seeds(30);
  again[{1.0, 14.0, 10'000, 1}]["poolpointer"] = seeds(33);
  const std::vector<RangeFinding> kept = confirmed(findings, again);
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].cell.klux, 2.0);
}

TEST_F(DynamicRangeTest, FindsAReadoutWhoseCountersFill) {
  // hisPointer v1 does not freeze its histogram: the other bins catch up with a full one.
  RangeSettings settings = small_study();
  settings.readouts = {ReadoutParameters::defaults(Readout::kHisPointer1)};
  settings.readouts[0].count_width = 3;
  settings.acquisitions = {1000, 3000};
  settings.klux = {14.0};
  const DynamicRange study = run_dynamic_range(settings);
  ASSERT_FALSE(study.more_acquisitions.empty());
  EXPECT_EQ(study.more_acquisitions[0].readout, "hispointer1");
  EXPECT_EQ(study.more_acquisitions[0].cell.acquisitions, 3000U);
  EXPECT_EQ(pool_findings(study), 0U);
  EXPECT_THAT(page_text("dynamic_range", dynamic_range_page(settings, study, "command")),
              HasSubstr("No entry."));
}

TEST_F(DynamicRangeTest, ComparesFullCountersWithWideOnes) {
  RangeSettings settings = small_study();
  settings.readouts[0].count_width = 1;
  const DynamicRange study = run_dynamic_range(settings);
  EXPECT_TRUE(study.more_acquisitions.empty()) << "a full bin freezes the coarse histogram";
  const RangeCounts& full = study.full.at({1.0, 2.0, 3000}).at("coarsehistogram").front();
  EXPECT_EQ(full.pixels, 8U * 34U);
  EXPECT_GT(full.full, full.pixels / 2);
  EXPECT_GT(full.changed, full.pixels / 2);
  EXPECT_LT(full.wide_above_3_percent, full.above_3_percent);
  EXPECT_THAT(page_text("dynamic_range", dynamic_range_page(settings, study, "command")),
              HasSubstr("counters give more errors above 10 %, beyond both intervals, in: coarse histogram"));

  settings.store = folder_ / "wide";
  settings.readouts[0].count_width = 16;
  const DynamicRange wide = run_dynamic_range(settings);
  EXPECT_TRUE(wide.more_acquisitions.empty());
  EXPECT_EQ(wide.full.at({1.0, 2.0, 3000}).at("coarsehistogram").front().changed, 0U);
  EXPECT_THAT(page_text("dynamic_range", dynamic_range_page(settings, wide, "command")),
              HasSubstr("beyond both intervals, in: no cell"));
}

TEST_F(DynamicRangeTest, TakesCellsThatAreDone) {
  const RangeSettings settings = small_study();
  const std::vector<RangeCell> cells = range_grid(settings);
  ASSERT_EQ(cells.size(), 2U);
  const RangeResults first = measure_range_cells(settings, cells, "grid");
  EXPECT_EQ(measure_range_cells(settings, cells, "grid"), first);
  // A count that no measurement would give shows where the results come from.
  std::string text = read_file(folder_ / "grid_1_2_100_0.csv");
  text.replace(text.find(",272,"), 5, ",999,");
  write_file(folder_ / "grid_1_2_100_0.csv", text);
  RangeResults stored = measure_range_cells(settings, cells, "grid");
  EXPECT_EQ((stored[{1.0, 2.0, 100}]["coarsehistogram"][0].pixels), 999U);
  EXPECT_EQ((stored[{1.0, 2.0, 3000}]), (first.at({1.0, 2.0, 3000})));
  std::filesystem::remove(folder_ / "grid_1_2_100_0.csv");
  EXPECT_EQ(measure_range_cells(settings, cells, "grid"), first);
}

TEST_F(DynamicRangeTest, DependsNeitherOnThreadsNorOnTheOtherReadouts) {
  RangeSettings settings = small_study();
  settings.readouts = {ReadoutParameters::defaults(Readout::kHisPointer),
                       ReadoutParameters::defaults(Readout::kPoolPointer),
                       ReadoutParameters::defaults(Readout::kPoolPointerLean)};
  settings.threads = 1;
  const RangeCell cell = {10.0, 14.0, 300};
  const RangeReadouts one = measure_range_cell(settings, cell);
  settings.threads = 3;
  EXPECT_EQ(measure_range_cell(settings, cell), one);
  for (const ReadoutParameters& readout : settings.readouts) {
    RangeSettings alone = settings;
    alone.readouts = {readout};
    const std::string name(readout_name(readout.readout));
    EXPECT_EQ(measure_range_cell(alone, cell).at(name), one.at(name)) << name;
  }
  RangeCell other = cell;
  other.repeat = 1;
  EXPECT_NE(measure_range_cell(settings, other), one) << "other photons";
}

TEST_F(DynamicRangeTest, MoreSignalAndMoreAcquisitionsHelpAWideHistogram) {
  RangeSettings settings = small_study();
  settings.readouts[0].count_width = 16;
  const auto share = [&](double signal, std::uint32_t acquisitions) {
    return range_share(measure_range_cell(settings, {signal, 14.0, acquisitions}).at("coarsehistogram"),
                       &RangeCounts::above_3_percent)
        .value;
  };
  EXPECT_LT(share(1.0, 3000), 0.5 * share(1.0, 100));
  EXPECT_LT(share(10.0, 300), 0.5 * share(1.0, 300));
}

TEST_F(DynamicRangeTest, RefusesWhatItCannotMeasure) {
  const auto refused = [&](void (*change)(RangeSettings&), const char* message) {
    RangeSettings settings = small_study();
    change(settings);
    EXPECT_THAT([&] { measure_range_cells(settings, range_grid(settings), "grid"); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refused([](RangeSettings& s) { s.seeds = 1; }, "2 seeds");
  refused([](RangeSettings& s) { s.rows = 161; }, "161 rows");
  refused([](RangeSettings& s) { s.rows = 0; }, "0 rows");
  refused([](RangeSettings& s) { s.sensor.columns = 49; }, "160 rows of 49");
  refused([](RangeSettings& s) { s.signals = {0.0}; }, "signal");
  refused([](RangeSettings& s) { s.klux.clear(); }, "a light");
  refused([](RangeSettings& s) { s.sensor.binning = 2; }, "binning");
}

TEST(DynamicRangeLists, ReportListsTheEntriesOfPoolReadouts) {
  RangeSettings settings;
  settings.sensor = parse_preset("thesis");
  settings.readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram),
                       ReadoutParameters::defaults(Readout::kPoolPointer)};
  settings.acquisitions = {3333, 33'333};
  settings.klux = {14.0};
  settings.signals = {1.0};
  DynamicRange study;
  for (const auto& [acquisitions, above] : {std::pair{3333U, 1U}, std::pair{33'333U, 543U}}) {
    study.grid[{1.0, 14.0, acquisitions}]["poolpointer"] = seeds(above);
    study.grid[{1.0, 14.0, acquisitions}]["coarsehistogram"] = seeds(6);
  }
  study.more_acquisitions = worse_with_more(study.grid, Grown::kAcquisitions);
  study.behind = behind_coarse_histogram(study.grid, kManyAcquisitions);
  EXPECT_EQ(pool_findings(study), 2U);
  const std::string report = page_text("dynamic_range", dynamic_range_page(settings, study, "the command"));
  EXPECT_THAT(report, HasSubstr("More acquisitions made a pool read-out worse: poolPointer: 1 entry."));
  EXPECT_THAT(report, HasSubstr("More signal made a pool read-out worse: poolPointer: 0 entries."));
  EXPECT_THAT(report, HasSubstr("54.30 ("));
  EXPECT_THAT(report, HasSubstr("3333 acquisitions"));
  EXPECT_THAT(report, HasSubstr("0.1 / 0"));
  EXPECT_THAT(report, HasSubstr("Command: `the command`"));
  EXPECT_THAT(report, Not(HasSubstr("Full counters")));
  EXPECT_THAT(dynamic_range_csv(study).csv(), HasSubstr("poolpointer,grid,1,14,33333,2000,0.543,"));
  const std::vector<PlotSeries> curves = dynamic_range_curves(settings, study);
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[1].label, "poolPointer");
  EXPECT_NEAR(curves[1].y.back(), 54.3, 1e-9);
}

}  // namespace
}  // namespace dtof
