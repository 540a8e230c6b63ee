// SPDX-License-Identifier: Apache-2.0
#include "walk_error/walk_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "walk_error/walk_report.hpp"

namespace dtof {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::ThrowsMessage;

WalkSettings small_walk_study() {
  WalkSettings settings;
  settings.sensor = parse_preset("thesis");
  settings.sensor.acquisitions = 1000;
  settings.readouts = {ReadoutParameters::defaults(Readout::kHistogram)};
  settings.reflectivities = {0.1, 1.0};
  settings.distances_m = {0.3, 1.0};
  settings.columns = 4;
  return settings;
}

TEST(WalkStudy, DimTargetsSeemFartherThanTheTablesBrightOnes) {
  const std::vector<WalkReadout> results = run_walk_study(small_walk_study());
  ASSERT_EQ(results.size(), 1U);
  const WalkReadout& histogram = results.front();
  ASSERT_EQ(histogram.points.size(), 4U);
  EXPECT_EQ(histogram.judged(), 4U);
  const WalkPoint& dim = histogram.points[0];
  const WalkPoint& bright = histogram.points[2];
  EXPECT_EQ(dim.reflectivity, 0.1);
  EXPECT_EQ(bright.reflectivity, 1.0);
  EXPECT_EQ(bright.distance_m, 0.3);
  // The table is made for the bright one. At 0.3 m 3.3 signal events share two slots: the pulse moves by
  // centimetres.
  EXPECT_NEAR(bright.before.bias_m.value, 0.0, 0.01);
  EXPECT_GT(dim.before.bias_m.value, 0.02);
  EXPECT_GT(dim.found, 0.5);
  EXPECT_LT(std::abs(dim.after.bias_m.value), 0.5 * dim.before.bias_m.value);
  EXPECT_GE(histogram.better(), 1U);
  EXPECT_GE(histogram.classes, 4U);
}

TEST(WalkStudy, DoesNotDependOnTheThreads) {
  WalkSettings settings = small_walk_study();
  settings.readouts.push_back(ReadoutParameters::defaults(Readout::kPoolPointer));
  settings.threads = 1;
  const std::vector<WalkReadout> one = run_walk_study(settings);
  settings.threads = 3;
  const std::vector<WalkReadout> three = run_walk_study(settings);
  for (std::size_t r = 0; r < one.size(); ++r) {
    for (std::size_t i = 0; i < one[r].points.size(); ++i) {
      EXPECT_EQ(one[r].points[i].before.bias_m, three[r].points[i].before.bias_m);
      EXPECT_EQ(one[r].points[i].after.bias_m, three[r].points[i].after.bias_m);
    }
  }
}

TEST(WalkStudy, ColumnsThatUseEachOtherAreReadInPairs) {
  WalkSettings settings = small_walk_study();
  const std::vector<WalkReadout> alone = run_walk_study(settings);
  settings.readouts.push_back(ReadoutParameters::defaults(Readout::kPoolPointer));
  const std::vector<WalkReadout> both = run_walk_study(settings);
  for (std::size_t i = 0; i < alone[0].points.size(); ++i) {
    EXPECT_EQ(both[0].points[i].before.bias_m, alone[0].points[i].before.bias_m) << "the same photons";
    EXPECT_EQ(both[0].points[i].after.bias_m, alone[0].points[i].after.bias_m);
  }
  // Half of the pairs' counts would be missing without their left columns, and with them pixels at 0.1.
  EXPECT_EQ(both[1].judged(), 4U);
  for (const WalkPoint& point : both[1].points) {
    EXPECT_GT(point.found, 0.95) << point.reflectivity << " " << point.distance_m;
  }
}

TEST(WalkReadout, FiguresByHand) {
  const auto errors = [](double bias) {
    return WalkErrors{{bias, {bias - 0.001, bias + 0.001}}, 0.0, 0.0, 0.0};
  };
  const WalkReadout readout{"x",
                            "x",
                            1,
                            0.0,
                            {{0.1, 1.0, 1.0, true, errors(0.03), errors(-0.01)},
                             {0.2, 1.0, 1.0, true, errors(-0.04), errors(0.0395)},
                             {0.5, 1.0, 1.0, true, errors(0.0), errors(0.01)},
                             {1.0, 1.0, 0.4, false, errors(9.0), errors(0.0)}}};
  EXPECT_EQ(readout.judged(), 3U);
  EXPECT_NEAR(readout.rms_bias_before_m(), std::sqrt(0.0025 / 3.0), 1e-12);
  EXPECT_NEAR(readout.walk_before_m(), 0.07, 1e-12);
  EXPECT_NEAR(readout.walk_after_m(), 0.0495, 1e-12);
  EXPECT_EQ(readout.better(), 1U);  // 30 to 10 mm; 40 to 39.5 is within the intervals
  EXPECT_EQ(readout.worse(), 1U);
}

TEST(WalkReport, NamesWhatTheCorrectionDoes) {
  WalkSettings settings = small_walk_study();
  settings.reflectivities = {0.5, 1.0};
  settings.distances_m = {2.0};
  // The walk in m, before and after the correction.
  const auto readout = [](const char* title, double before, double after, bool judged = true) {
    const auto errors = [](double bias) {
      return WalkErrors{{bias, {bias - 0.001, bias + 0.001}}, 0.0, 0.0, 0.0};
    };
    return WalkReadout{title,
                       title,
                       3,
                       0.25,
                       {{0.5, 2.0, 1.0, judged, errors(0.01 + before), errors(0.01 + after)},
                        {1.0, 2.0, 1.0, judged, errors(0.01), errors(0.01)}}};
  };
  const std::string page = page_text(
      "walk_error", walk_page(settings,
                              {readout("A", 0.08, 0.03), readout("B", 0.08, 0.05), readout("C", 0.08, 0.09),
                               readout("D", 0.06, 0.02), readout("E", 0.06, 0.03, false)},
                              "the command"));
  EXPECT_THAT(
      page,
      HasSubstr("# Walk error\n\nEvents of a bright target fill the 2 slots of the TDC early (pile-up), so "
                "that the target seems nearer. Measured with flat targets: 640 pixels at each "
                "reflectivity and distance, 14 klux, sensor thesis, 1000 acquisitions, seed 1.\n\n* Before: "
                "the look-up table is "
                "fitted on flat targets of reflectivity 1 at "));
  EXPECT_THAT(page,
              HasSubstr("|\n\n* The walk is at least halved: A (80 to 30 mm), D (60 to 20 mm).\n"
                        "* The walk is reduced by less than half: B (80 to 50 mm).\n"
                        "* The walk is not reduced: C (80 to 90 mm).\n"
                        "* The walk could not be judged: E.\n\n"
                        "[walk_error.csv](walk_error.csv) has all points, with shares of errors. Bias in mm, "
                        "before -> after:\n\n## A\n\n| reflectivity "));
  EXPECT_THAT(page, HasSubstr("| 90.0 +- 1.0 -> 40.0 +- 1.0 |"));
  EXPECT_THAT(page, EndsWith("\n\nCommand: `the command`\n"));
}

TEST(WalkStudy, RefusesWhatMakesNoStudy) {
  const auto refused = [](auto change, const char* reason) {
    WalkSettings settings = small_walk_study();
    change(settings);
    EXPECT_THAT([&] { (void)run_walk_study(settings); }, ThrowsMessage<InputError>(HasSubstr(reason)))
        << reason;
  };
  refused([](WalkSettings& s) { s.columns = 3; }, "at least 4 columns");
  refused([](WalkSettings& s) { s.reflectivities = {1.0}; }, "two reflectivities");
  refused([](WalkSettings& s) { s.reflectivities[0] = 0.0; }, "above 0, not 0");
  refused([](WalkSettings& s) { s.distances_m[0] = std::numeric_limits<double>::quiet_NaN(); }, "not nan m");
  refused([](WalkSettings& s) { s.sensor.binning = 2; }, "binning");
}

}  // namespace
}  // namespace dtof
