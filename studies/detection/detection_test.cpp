// SPDX-License-Identifier: Apache-2.0
#include "detection/detection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

DetectionSettings small_detection_study() {
  DetectionSettings settings;
  settings.sensor = find_sensor("thesis");
  settings.sensor.rows = 24;
  settings.readouts = {ReadoutParameters::defaults(Readout::kEzPointer),
                       ReadoutParameters::defaults(Readout::kPoolPointer)};
  settings.klux = {14.0, 50.0};
  settings.distances_m = {3.0, 4.0};
  settings.false_alarms = 0.01;
  settings.seeds = 2;
  return settings;
}

TEST(Detection, PoolPointerSeparatesAWallFromASkyWithOneThreshold) {
  const std::vector<ReadoutDetection> study = run_detection(small_detection_study());
  ASSERT_EQ(study.size(), 2U);
  for (const ReadoutDetection& readout : study) {
    ASSERT_EQ(readout.cells.size(), 4U);
    ASSERT_EQ(readout.held_out_alarms.size(), 6U);
    for (const DetectionCell& cell : readout.cells) {
      EXPECT_LE(cell.detected.value, cell.right.value);
    }
  }
  const ReadoutDetection& pool = study[1];
  EXPECT_LE(std::ranges::max(pool.held_out_alarms), 0.03);
  for (const DetectionCell& cell : pool.cells) {
    EXPECT_GE(cell.detected.value, 0.97) << cell.klux << " klux, " << cell.distance_m << " m";
  }
  EXPECT_LT(study[0].cells.back().detected.value, 0.5);
}

TEST(Detection, ReportAndPictureHaveEveryCell) {
  const DetectionSettings settings = small_detection_study();
  const std::vector<ReadoutDetection> study = {
      {.readout = Readout::kPoolPointer,
       .threshold = 40,
       .held_out_alarms = {0.0, 0.0005, 0.0, 0.0, 0.0, 0.0},
       .cells = {
           {14.0, 3.0, {.value = 1.0, .interval = {1.0, 1.0}}, {.value = 1.0, .interval = {1.0, 1.0}}},
           {14.0, 4.0, {.value = 0.875, .interval = {0.8, 0.9}}, {.value = 1.0, .interval = {1.0, 1.0}}},
           {50.0, 3.0, {.value = 0.5, .interval = {0.4, 0.6}}, {.value = 1.0, .interval = {1.0, 1.0}}},
           {50.0, 4.0, {.value = 0.25, .interval = {0.2, 0.3}}, {.value = 1.0, .interval = {1.0, 1.0}}}}}};
  const std::string report = page_text("detection", detection_page(settings, study, "dtof-study detection"));
  EXPECT_THAT(
      report,
      HasSubstr("\n\nSensor `thesis`. Each read-out has one threshold of confidence, which at most 0.01 of "
                "the pixels pass in any frame of sky alone, from 14 to 50 klux, and for skies as bright "
                "as surfaces of reflectivity 0.5 to 2. The targets are walls of reflectivity "
                "0.5.\n\n* At 14 klux "));
  EXPECT_THAT(
      report,
      HasSubstr("\n\nModels, exact photons, 2 seeds: 34 columns of 24 rows that look at one target. "
                "The threshold is the lowest confidence that at most 0.01 of the pixels reach in each "
                "of 6 skies; false alarms are counted in frames of other seeds. "
                "data/detection.csv.gz has the intervals.\n\nCommand: `dtof-study detection`\n"));
  EXPECT_THAT(report, HasSubstr("87.50 / 100.00"));
  EXPECT_THAT(report, HasSubstr("25.00 / 100.00"));
  EXPECT_THAT(report, HasSubstr("At 14 klux at least 90 % of the pixels of a wall pass and are at most 10 % "
                                "off: poolPointer to 3 m."));
  EXPECT_THAT(report, HasSubstr("At 50 klux at least 90 % of the pixels of a wall pass and are at most 10 % "
                                "off: with no read-out."));
  EXPECT_THAT(report, HasSubstr("0.50"));
  const std::vector<PlotSeries> curves = detection_curves(settings, study);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_EQ(curves[0].x, (std::vector<double>{3.0, 4.0}));
  EXPECT_EQ(curves[0].y, (std::vector<double>{50.0, 25.0}));
  EXPECT_THAT(detection_csv(study).csv(), HasSubstr("poolpointer,40,14,4,0.875000,0.800000,0.900000"));
}

TEST(Detection, RefusesSettingsOutOfRange) {
  DetectionSettings settings = small_detection_study();
  settings.seeds = 1;
  EXPECT_THAT([&] { run_detection(settings); }, ThrowsMessage<InputError>(HasSubstr("at least 2 seeds")));
  settings = small_detection_study();
  settings.false_alarms = std::nan("");
  EXPECT_THAT([&] { run_detection(settings); }, ThrowsMessage<InputError>(HasSubstr("false alarms")));
  settings = small_detection_study();
  settings.sensor.columns = 20;
  EXPECT_THAT([&] { run_detection(settings); }, ThrowsMessage<InputError>(HasSubstr("20")));
}

}  // namespace
}  // namespace dtof
