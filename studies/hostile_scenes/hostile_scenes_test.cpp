// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/hostile_scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/engine_frame.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset.hpp"
#include "hostile_scenes/hostile_report.hpp"

namespace dtof {
namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// 1,000 pixels with a target and 100 without; the wrong ones have confidence 1, the right ones 5, the sky's
/// 0 to 9.
HostileCounts counts(std::uint64_t within_10, std::uint64_t beyond) {
  HostileCounts made;
  made.by_confidence = {{{{5, 1000 - within_10 - beyond}}, {{1, within_10}}, {{1, beyond}}, {}}};
  for (int confidence = 0; confidence < 10; ++confidence) {
    made.by_confidence[static_cast<std::size_t>(Outcome::kSky)][confidence] = 10;
  }
  return made;
}

std::vector<HostileCounts> hostile_seeds(std::uint64_t within_10, std::uint64_t beyond = 0) {
  return {counts(within_10, beyond), counts(within_10, beyond)};
}

TEST(HostileFigures, AreSharesOfTheirPixels) {
  const std::vector<HostileCounts> made = {counts(20, 10), counts(40, 30)};
  EXPECT_EQ(made[0].targets(), 1000U);
  EXPECT_DOUBLE_EQ(share_above(made, 3).value, 0.05);
  EXPECT_DOUBLE_EQ(share_above(made, 10).value, 0.02);
  EXPECT_DOUBLE_EQ(share_detected(made, 0).value, 0.95);
  EXPECT_DOUBLE_EQ(share_detected(made, 5).value, 0.95);
  EXPECT_DOUBLE_EQ(share_detected(made, 6).value, 0.0);
  EXPECT_DOUBLE_EQ(share_of_false_alarms(made, 0)->value, 1.0);
  EXPECT_DOUBLE_EQ(share_of_false_alarms(made, 7)->value, 0.3);
  std::vector<HostileCounts> no_sky = made;
  for (HostileCounts& each : no_sky) {
    each.by_confidence[static_cast<std::size_t>(Outcome::kSky)].clear();
  }
  EXPECT_FALSE(share_of_false_alarms(no_sky, 0).has_value());
}

TEST(HostileFigures, ThresholdIsTheLowestThatKeepsEveryLightsSkyQuiet) {
  // 200 sky pixels: a tenth of them at each confidence.
  EXPECT_EQ(least_confidence({hostile_seeds(0)}, 0.1), 9);
  EXPECT_EQ(least_confidence({hostile_seeds(0)}, 0.0999), 10);
  EXPECT_EQ(least_confidence({hostile_seeds(0)}, 0.35), 7);
  std::vector<HostileCounts> brighter = hostile_seeds(0);
  brighter[1].by_confidence[static_cast<std::size_t>(Outcome::kSky)][30] = 60;
  EXPECT_EQ(least_confidence({brighter, hostile_seeds(0)}, 0.1), 31) << "the worst light decides";
  EXPECT_EQ(least_confidence({hostile_seeds(0), brighter}, 0.1), 31);
}

class HostileReport : public testing::Test {
 protected:
  HostileReport() {
    settings_.sensor = parse_preset("thesis");
    settings_.readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram),
                          ReadoutParameters::defaults(Readout::kPoolPointer)};
    settings_.conditions = {"clear", "fog", "late-laser"};
    settings_.klux = {14.0};
    for (const std::string& condition : settings_.conditions) {
      HostileReadouts& readouts = study_.cells[{condition, 14.0}];
      for (const std::string& name : hostile_estimators(settings_)) {
        readouts[name] = hostile_seeds(20);
        study_.thresholds[name] = 5;
      }
    }
    for (const char* condition : {"fog", "late-laser"}) {
      for (const std::string& name : compensated_estimators(settings_)) {
        study_.compensated[{condition, 14.0}][name] = hostile_seeds(20);
      }
    }
  }

  [[nodiscard]] std::string page(const std::string& command_line = "") const {
    return page_text("hostile_scenes", hostile_page(settings_, study_, command_line));
  }

  void add_motion() {
    settings_.conditions.emplace_back("motion");
    for (const std::string& name : hostile_estimators(settings_)) {
      study_.cells[{"motion", 14.0}][name] = hostile_seeds(30);
      study_.compensated[{"motion", 14.0}][name] = hostile_seeds(20);
      study_.instants[{"motion", 14.0}].instants[name] = {0.75, std::nullopt};
    }
    study_.instants[{"motion", 14.0}].distances_m = {1.0, 3.0};
  }

  HostileSettings settings_;
  HostileScenes study_;
};

TEST_F(HostileReport, NamesTheConditionsThatAPoolReadoutDoesNotSurvive) {
  EXPECT_THAT(behind_coarse_histogram(settings_, study_, "poolpointer", false), IsEmpty());
  study_.cells[{"late-laser", 14.0}]["poolpointer"] = hostile_seeds(0, 400);
  study_.cells[{"fog", 14.0}]["poolpointer"] = hostile_seeds(40);  // twice, within the intervals
  EXPECT_THAT(behind_coarse_histogram(settings_, study_, "poolpointer", false),
              ElementsAre("late-laser (14 klux)"));
  EXPECT_THAT(behind_coarse_histogram(settings_, study_, "poolpointer", true), IsEmpty())
      << "it is compensated";
  const std::string report = page("the command");
  EXPECT_THAT(
      report,
      HasSubstr("poolPointer has more than twice the errors above 3 % of the coarse histogram, beyond "
                "both intervals: late-laser (14 klux)."));
  EXPECT_THAT(report, HasSubstr("(in brackets the share of the best read-out): no condition."));
  EXPECT_THAT(report, HasSubstr("coarse histogram 98, poolPointer 98, matched filter 98"));
  EXPECT_THAT(report, HasSubstr("* fog: fog of 39 m visibility"));
  EXPECT_THAT(report, HasSubstr("Command: `the command`"));
}

TEST_F(HostileReport, SaysHowItWasMeasured) {
  settings_.rows = 8;
  settings_.seeds = 2;
  settings_.seed = 3;
  EXPECT_THAT(
      page("the command"),
      HasSubstr(
          "# What each read-out survives\n\n2 read-outs and two matched filters under 3 conditions, sensor "
          "`thesis`, 14 klux.\n\n* Conditions under which "));
  EXPECT_THAT(
      page("the command"),
      HasSubstr(
          "\n\n## How it was measured\n\nModels, exact photons. Scenes room, planes, poles, sky: 8 rows of "
          "the 34 columns (an engine of poolPointer) around the centre of the sensor's pixels. 2 seeds "
          "from 3 on, each with 1000 pixels with a target and 100 without. Each estimator has one look-up "
          "table for each light, from the sensor in clear conditions, and subtracts the known skew. Except "
          "where a table says so, it has no other knowledge of the conditions. There is no host "
          "filter.\n\nThe threshold of an estimator is the lowest confidence that at most 1 % of the pixels "
          "of frames of sky alone "
          "reach, in clear conditions, at each light. One threshold serves all lights and conditions."));
}

TEST_F(HostileReport, NamesWhatFoolsEveryReadout) {
  study_.cells[{"fog", 14.0}]["poolpointer"] = hostile_seeds(0, 300);
  EXPECT_THAT(fooled_together(settings_, study_), IsEmpty()) << "the coarse histogram is not";
  study_.cells[{"fog", 14.0}]["coarsehistogram"] = hostile_seeds(0, 250);
  EXPECT_THAT(fooled_together(settings_, study_), ElementsAre("fog (25 % at 14 klux)"))
      << "filters do not count";
}

TEST_F(HostileReport, TablesHoldEveryFigure) {
  study_.cells[{"fog", 14.0}]["poolpointer"] = hostile_seeds(100, 150);
  const std::string csv = hostile_csv(settings_, study_).csv();
  EXPECT_THAT(csv, HasSubstr("\npoolpointer,fog,14,2000,0.25,"));
  EXPECT_THAT(csv, HasSubstr(",5,0.75,"));
  EXPECT_THAT(csv, HasSubstr(",200,0.5,"));
  EXPECT_THAT(page(), HasSubstr(" 25 / 15 |"));
  EXPECT_THAT(page(), HasSubstr(" 50 / 75 |"));
  const std::vector<PlotSeries> curves = hostile_curves(settings_, study_);
  ASSERT_EQ(curves.size(), 4U);
  EXPECT_THAT(curves[0].x, testing::Contains(testing::DoubleEq(50.0)));
}

TEST_F(HostileReport, NamesWhatRemainsOfTheCompensatedEstimators) {
  study_.cells[{"clear", 14.0}]["poolpointer"] = hostile_seeds(0, 400);  // no error can be told from these
  study_.cells[{"fog", 14.0}]["poolpointer"] = hostile_seeds(0, 400);
  study_.compensated[{"late-laser", 14.0}]["poolpointer"] = hostile_seeds(0, 70);
  EXPECT_THAT(behind_coarse_histogram(settings_, study_, "poolpointer", true),
              ElementsAre("clear (14 klux)", "late-laser (14 klux)"));
  study_.compensated[{"late-laser", 14.0}]["coarsehistogram"] = hostile_seeds(0, 60);
  EXPECT_THAT(behind_coarse_histogram(settings_, study_, "poolpointer", true), ElementsAre("clear (14 klux)"))
      << "the coarse histogram has its settings, too";
  EXPECT_THAT(
      page(),
      HasSubstr("* The same if both have the settings of a user who knows these conditions (below): clear "
                "(14 klux). Pixels of poolPointer above 3 % with these settings, in % at 14 klux: fog "
                "2, late-laser 7.\n"));
}

TEST_F(HostileReport, HasTheErrorsOfTheCompensatedEstimators) {
  EXPECT_THAT(compensated_conditions(settings_), ElementsAre("fog", "late-laser"));
  EXPECT_THAT(compensated_estimators(settings_),
              ElementsAre("coarsehistogram", "poolpointer", "matchedfilter", "pooledmatchedfilter"));
  study_.compensated[{"fog", 14.0}]["poolpointer"] = hostile_seeds(10, 60);
  const std::string report = page();
  EXPECT_THAT(report, HasSubstr(" 7 / 6 | "));
  EXPECT_THAT(hostile_csv(settings_, study_).csv(), HasSubstr("\npoolpointer,told-fog,14,2000,0.07,"));
  settings_.conditions = {"clear", "settling-laser"};
  study_.cells[{"settling-laser", 14.0}] = study_.cells[{"clear", 14.0}];
  EXPECT_THAT(compensated_conditions(settings_), IsEmpty());
  EXPECT_THAT(page(), Not(HasSubstr("## With settings")));
  EXPECT_THAT(page(), Not(HasSubstr("own instant")));
  settings_.conditions = {"clear", "glass", "column-skew", "pixel-skew", "other-laser-6ppm", "motion"};
  EXPECT_THAT(compensated_conditions(settings_), ElementsAre("glass", "column-skew", "pixel-skew", "motion"));
}

TEST_F(HostileReport, JudgesMotionBothWays) {
  add_motion();
  std::vector<HostileCounts> biased = hostile_seeds(100, 150);
  biased[0].near_target = biased[1].near_target = 500;
  biased[0].error_um = 12'000'000;
  biased[1].error_um = 8'000'000;
  study_.cells[{"motion", 14.0}]["poolpointer"] = biased;
  EXPECT_DOUBLE_EQ(mean_error(biased), 0.02);
  EXPECT_DOUBLE_EQ(mean_error(hostile_seeds(20)), 0.0);
  const std::string report = page();
  EXPECT_THAT(report, HasSubstr("motion, 14 klux:"));
  EXPECT_THAT(report, ContainsRegex("poolPointer +\\| +0\\.84 +\\| +0\\.75 +\\| +- +\\| +20 +\\| +25 / 15 "
                                    "+\\| +0 +\\| +2 / 0 "));
  EXPECT_THAT(report, ContainsRegex("matched filter +\\| +0\\.50 +\\| +0\\.75 "));
}

TEST(OwnInstant, IsWhereTheTargetIsWhatTheReadOutSays) {
  // A wall that is 40 mm too far when it goes away and 20 mm too near when it comes: 10 mm too far alike.
  EXPECT_DOUBLE_EQ(own_instant(0.04, -0.02, 0.3), 0.6);
  EXPECT_DOUBLE_EQ(own_instant(-0.01, -0.01, 0.3), 0.5);
}

TEST(OwnInstant, LiesBetweenTheWallsInProportion) {
  const OwnInstants own{.distances_m = {1.0, 2.0, 4.0, 5.0},
                        .instants = {{"one", {0.8, std::nullopt, 0.5, std::nullopt}},
                                     {"late", {std::nullopt, 0.7, 0.6, 0.9}},
                                     {"none", {std::nullopt, std::nullopt, std::nullopt, std::nullopt}}}};
  EXPECT_DOUBLE_EQ(own.at("one", 0.3), 0.8);
  EXPECT_DOUBLE_EQ(own.at("one", 1.0), 0.8);
  EXPECT_DOUBLE_EQ(own.at("one", 3.0), 0.6);
  EXPECT_DOUBLE_EQ(own.at("one", 6.0), 0.5);
  EXPECT_DOUBLE_EQ(own.at("late", 1.5), 0.7);
  EXPECT_DOUBLE_EQ(own.at("late", 9.0), 0.9);
  EXPECT_DOUBLE_EQ(own.at("none", 3.0), 0.5);
  EXPECT_DOUBLE_EQ(own.at("another", 3.0), 0.5);
}

TEST(OwnInstant, MiddleOfThePartThatMakesThePosition) {
  const auto middle = [](Readout readout) {
    return middle_of_position(ReadoutParameters::defaults(readout));
  };
  EXPECT_EQ(middle(Readout::kCoarseHistogram), 0.5);
  EXPECT_EQ(middle(Readout::kEzPointer), 0.5);
  EXPECT_EQ(middle(Readout::kHisPointer), 0.75);
  EXPECT_EQ(middle(Readout::kPifh), std::nullopt);
  EXPECT_EQ(middle(Readout::kPoolPointer), (44.0 / 64 + 1) / 2);
  EXPECT_EQ(middle(Readout::kPoolPointerLean), (34.0 / 64 + 1) / 2);
}

class HostileScenesTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("dtof_hostile_" + std::to_string(getpid()));
    settings_.sensor = parse_preset("thesis");
    settings_.sensor.acquisitions = 1000;
    settings_.readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram)};
    settings_.conditions = {"clear", "glass", "column-skew"};
    settings_.klux = {2.0};
    settings_.scenes = {Scene::kRoom, Scene::kSky};
    settings_.rows = 8;
    settings_.seeds = 2;
    settings_.store = folder_;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  HostileSettings settings_;
  std::filesystem::path folder_;
};

TEST_F(HostileScenesTest, GlassFoolsAndSkewIsSubtracted) {
  const HostileScenes study = run_hostile_scenes(settings_);
  for (const std::string& name : hostile_estimators(settings_)) {
    const auto errors = [&](const char* condition) {
      return share_above(study.cells.at({condition, 2.0}).at(name), 10).value;
    };
    EXPECT_LT(errors("clear"), 0.02) << name;
    EXPECT_GT(errors("glass"), 0.4) << name;
    EXPECT_LT(errors("column-skew"), 0.02) << name;
    const auto figures = [&](const char* condition) {
      const std::vector<HostileCounts>& own = study.cells.at({condition, 2.0}).at(name);
      return std::pair(share_of_false_alarms(own, study.thresholds.at(name))->value,
                       share_detected(own, study.thresholds.at(name)).value);
    };
    EXPECT_LT(figures("clear").first, 0.1) << name;
    EXPECT_GT(figures("clear").second, 0.8) << name;
    EXPECT_GT(figures("glass").first, 0.9) << name << ": the sky before the glass is no sky to it";
  }
  // Without the subtraction 440 ps are 66 mm, more than 3 % of anything nearer than 2.2 m.
  const Estimate skewed = share_above(study.cells.at({"column-skew", 2.0}).at("matchedfilter"), 3);
  EXPECT_LT(skewed.value, 0.05);
  const HostileCounts& one = study.cells.at({"clear", 2.0}).at("coarsehistogram").front();
  EXPECT_EQ(one.targets() + one.count(Outcome::kSky),
            static_cast<std::uint64_t>(2 * engine_columns_judged() * settings_.rows));
}

TEST_F(HostileScenesTest, GlassDoesNotFoolCompensatedEstimators) {
  settings_.readouts = {ReadoutParameters::defaults(Readout::kPoolPointer)};
  settings_.conditions = {"clear", "glass"};
  const HostileScenes study = run_hostile_scenes(settings_);
  for (const std::string& name : hostile_estimators(settings_)) {
    const double uncompensated = share_above(study.cells.at({"glass", 2.0}).at(name), 10).value;
    EXPECT_GT(uncompensated, 0.4) << name;
    EXPECT_LT(share_above(study.compensated.at({"glass", 2.0}).at(name), 10).value, 0.2 * uncompensated)
        << name;
  }
}

TEST_F(HostileScenesTest, ALateLaserDoesNotFoolCompensatedEstimators) {
  settings_.readouts = {ReadoutParameters::defaults(Readout::kCoarseHistogram),
                        ReadoutParameters::defaults(Readout::kPoolPointer)};
  settings_.conditions = {"clear", "late-laser"};
  EXPECT_EQ(silent_acquisitions(under_condition(settings_.sensor, "late-laser")), 220U);
  EXPECT_EQ(silent_acquisitions(settings_.sensor), 0U);
  const HostileScenes study = run_hostile_scenes(settings_);
  const auto errors = [](const HostileReadouts& readouts) {
    return share_above(readouts.at("poolpointer"), 10).value;
  };
  EXPECT_GT(errors(study.cells.at({"late-laser", 2.0})), 0.2);
  EXPECT_LT(errors(study.compensated.at({"late-laser", 2.0})), 0.05);
}

TEST_F(HostileScenesTest, SkewDoesNotFoolCompensatedEstimators) {
  settings_.sensor.acquisitions = 3333;
  settings_.readouts = {ReadoutParameters::defaults(Readout::kPoolPointer)};
  settings_.conditions = {"clear", "pixel-skew"};
  const HostileScenes study = run_hostile_scenes(settings_);
  const auto errors = [](const HostileReadouts& readouts) {
    return share_above(readouts.at("poolpointer"), 3).value;
  };
  EXPECT_LT(errors(study.compensated.at({"pixel-skew", 2.0})),
            0.5 * errors(study.cells.at({"pixel-skew", 2.0})));
}

TEST_F(HostileScenesTest, MotionIsJudgedAtTheOwnInstant) {
  settings_.sensor.acquisitions = 3333;
  settings_.readouts = {ReadoutParameters::defaults(Readout::kPoolPointer)};
  settings_.conditions = {"clear", "motion"};
  const HostileScenes study = run_hostile_scenes(settings_);
  const HostileCell cell{"motion", 2.0};
  const OwnInstants& own = study.instants.at(cell);
  EXPECT_GT(own.at("poolpointer", 1.0), 0.65) << "behind the track phase";
  EXPECT_NEAR(own.at("matchedfilter", 2.0), 0.5, 0.05);
  EXPECT_GT(mean_error(study.cells.at(cell).at("poolpointer")), 0.02);
  EXPECT_NEAR(mean_error(study.compensated.at(cell).at("poolpointer")), -0.02, 0.01)
      << "what is left is pile-up's, which draws what goes away and what comes nearer alike";
  EXPECT_LT(share_above(study.compensated.at(cell).at("poolpointer"), 3).value,
            0.5 * share_above(study.cells.at(cell).at("poolpointer"), 3).value);
}

TEST_F(HostileScenesTest, CellsThatAreDoneAreTaken) {
  settings_.conditions = {"clear"};
  const HostileScenes first = run_hostile_scenes(settings_);
  const HostileScenes again = run_hostile_scenes(settings_);
  EXPECT_EQ(again.cells, first.cells);
  EXPECT_EQ(again.thresholds, first.thresholds);
  write_file(folder_ / "clear_2.csv",
             "readout,seed,outcome,confidence,pixels\ncoarsehistogram,0,2,7,10\ncoarsehistogram,1,0,7,10\n");
  const std::vector<HostileCounts>& taken =
      run_hostile_scenes(settings_).cells.at({"clear", 2.0}).at("coarsehistogram");
  EXPECT_EQ(taken[0].count(Outcome::kBeyond), 10U);
  EXPECT_EQ(taken[1].count(Outcome::kWithin3), 10U);
}

TEST_F(HostileScenesTest, RefusesWhatItCannotMeasure) {
  const auto refused = [this](const char* word, auto change) {
    HostileSettings wrong = settings_;
    change(wrong);
    EXPECT_THAT([&] { run_hostile_scenes(wrong); }, testing::ThrowsMessage<InputError>(HasSubstr(word)));
  };
  refused("clear", [](HostileSettings& s) { s.conditions = {"glass"}; });
  refused("fgo", [](HostileSettings& s) { s.conditions = {"clear", "fgo"}; });
  refused("2 seeds", [](HostileSettings& s) { s.seeds = 1; });
  refused("false alarms", [](HostileSettings& s) { s.false_alarms = 0.0; });
  refused("rows", [](HostileSettings& s) { s.rows = 161; });
  refused("a scene", [](HostileSettings& s) { s.scenes.clear(); });
  refused("binning", [](HostileSettings& s) { s.sensor.binning = 2; });
}

}  // namespace
}  // namespace dtof
