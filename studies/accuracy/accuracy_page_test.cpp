// SPDX-License-Identifier: Apache-2.0
#include "accuracy/accuracy_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Estimate estimate(double value) { return {value, {0.9 * value, 1.1 * value}}; }

AccuracyPoint accuracy_point(const std::string& title, double distance_m, std::uint64_t frames,
                             bool reached) {
  AccuracyPoint point;
  point.estimator = title;
  point.title = title;
  point.klux = 14.0;
  point.distance_m = distance_m;
  point.frames = frames;
  point.precision_reached = reached;
  point.relative_precision = estimate(0.0123);
  point.rmse_m = estimate(0.05);
  point.outlier_rate = estimate(0.25);
  return point;
}

StudySettings sweep() {
  StudySettings settings;
  settings.sensor = parse_preset("thesis");
  settings.reflectivity = 0.5;
  settings.frames = 60;
  settings.most_frames = 900;
  settings.calibration_seed = 7;
  settings.run.seed = 3;
  settings.command = "the command";
  return settings;
}

std::vector<LightAccuracy> lights() {
  return {{14.0, {{accuracy_point("A", 1.0, 60, true), accuracy_point("B", 1.0, 900, false)}, {}}}};
}

TEST(AccuracyPage, SaysHowTheSweepWasMeasured) {
  const std::string page = page_text("accuracy", accuracy_page(sweep(), "exact", lights()));
  EXPECT_THAT(page,
              StartsWith("# Accuracy\n\nSensor thesis, reflectivity 0.5, 3333 acquisitions per frame, engine "
                         "model, photon model exact, seed 3. 60 frames per distance.\n"
                         "The look-up table is that of calibration run 7: 200 frames at every 0.05 m, at the "
                         "same light. It does not depend on\n"
                         "the seed; all figures after the table are those of this one table.\n\n"
                         "In brackets: 95 % confidence intervals, "));
  EXPECT_THAT(page, HasSubstr("arrival times only.\n\n## 14 klux\n\nRelative precision, %:\n\n"
                              "| distance m |    A |    B |\n"
                              "|------------|-----:|-----:|\n"
                              "| 1          | 1.23 | 1.23 |\n\n"
                              "Rmse after the look-up table, % of distance:\n\n"
                              "| distance m |    A |    B |\n"
                              "|------------|-----:|-----:|\n"
                              "| 1          | 5.00 | 5.00 |\n\n"
                              "Errors above 10 %, %:\n\n"
                              "| distance m |    A |    B |\n"
                              "|------------|-----:|-----:|\n"
                              "| 1          | 25.0 | 25.0 |\n\n\n"
                              "### A, 14 klux\n\n| distance m "));
  EXPECT_THAT(page, HasSubstr("\n\n### B, 14 klux\n\n| distance m "));
  EXPECT_THAT(page, EndsWith("|\n\nCommand: `the command`\n"));
}

TEST(AccuracyPage, SaysWhatIsReachedAndRejected) {
  StudySettings settings = sweep();
  settings.precision = 0.2;
  std::vector<LightAccuracy> measured = lights();
  measured[0].study.without_rejection = {"A", "B"};
  const std::string page = page_text("accuracy", accuracy_page(settings, "auto", measured));
  EXPECT_THAT(page,
              HasSubstr("photon model auto, which draws streams exactly, seed 3. 60 frames per distance or "
                        "more, up to 900, until the intervals of relative precision and rmse are within 20 % "
                        "and outliers are either ten or more, or none in so many frames that they are rarer "
                        "than 0.1 %.\n"));
  EXPECT_THAT(
      page, HasSubstr("|\n\nNo confidence leaves as few outliers as wanted, so nothing is rejected: A, "
                      "B.\nPrecision reached at 1 of 2 points, with up to 900 frames.\n\n### A, 14 klux\n"));
}

TEST(AccuracyPage, HasABandsErrorsOverAMap) {
  MapAccuracySettings settings;
  settings.sensor = parse_preset("thesis");
  settings.frames = 5;
  settings.run.seed = 3;
  settings.command = "the command";
  const BandAccuracy band = {.readout = "a",
                             .title = "A",
                             .klux = 2.0,
                             .from_m = 1.0,
                             .to_m = 2.0,
                             .pixels = 40,
                             .frames = 5,
                             .bias_m = estimate(0.02),
                             .rmse_m = estimate(0.1),
                             .above_3_percent = estimate(0.5),
                             .above_10_percent = estimate(0.1)};
  const auto page = [&](bool is_cube, const char* fidelity) {
    return page_text("accuracy_over_a_map",
                     map_accuracy_page(settings, {"A map.", is_cube}, fidelity, {{2.0, {band}}}));
  };
  const std::string map = page(false, "exact");
  EXPECT_THAT(
      map, StartsWith("# Accuracy over a map\n\nA map.\nSensor thesis, 3333 acquisitions a frame, 5 frames, "
                      "engine model, photon model exact, seed 3.\nLook-up table (--table flat): "));
  EXPECT_THAT(
      map, HasSubstr("\nErrors are against each pixel's own distance, by bands of it; the last line is the "
                     "whole range. In brackets: 95 % confidence intervals over the frames.\n\n## 2 klux\n\n"
                     "Rmse, mm:\n\n"
                     "| distance m   | pixels |             A |\n"
                     "|--------------|-------:|--------------:|\n"
                     "| 1.00 to 2.00 |     40 | 100 [90, 110] |\n\n"
                     "Bias, mm:\n\n"
                     "| distance m   | pixels |                 A |\n"
                     "|--------------|-------:|------------------:|\n"
                     "| 1.00 to 2.00 |     40 | 20.0 [18.0, 22.0] |\n\n"
                     "Errors above 3 %, % of pixels:\n\n"
                     "| distance m   | pixels |                    A |\n"
                     "|--------------|-------:|---------------------:|\n"
                     "| 1.00 to 2.00 |     40 | 50.00 [45.00, 55.00] |\n\n"
                     "Errors above 10 %, % of pixels:\n\n"
                     "| distance m   | pixels |                   A |\n"
                     "|--------------|-------:|--------------------:|\n"
                     "| 1.00 to 2.00 |     40 | 10.00 [9.00, 11.00] |\n\n\n"
                     "Command: `the command`\n"));
  EXPECT_THAT(map, Not(HasSubstr("strongest return")));
  EXPECT_THAT(page(true, "auto"),
              HasSubstr("A map. A pixel's distance is that of its strongest return.\nSensor "));
  EXPECT_THAT(page(true, "auto"), HasSubstr("photon model auto, which draws streams exactly, seed 3.\n"));
}

}  // namespace
}  // namespace dtof
