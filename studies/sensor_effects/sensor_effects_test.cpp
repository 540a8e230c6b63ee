// SPDX-License-Identifier: Apache-2.0
#include "sensor_effects/sensor_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace dtof {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

AccuracyPoint point(const std::string& title, double distance_m, double rmse_m) {
  AccuracyPoint point{};
  point.estimator = title;
  point.title = title;
  point.klux = 14.0;
  point.distance_m = distance_m;
  point.rmse_m = {rmse_m, {0.9 * rmse_m, 1.1 * rmse_m}};
  point.bias_m = {0.01, {0.0, 0.02}};
  point.above_3_percent = {0.1, {0.05, 0.15}};
  point.outlier_rate = {0.0, {0.0, 0.01}};
  return point;
}

SensorAccuracy clean() {
  return {SensorModel(),
          {point("A", 1.0, 0.02), point("A", 2.0, 0.04), point("B", 1.0, 0.05), point("B", 2.0, 0.06)}};
}

/// The page that compares one sensor with clean().
std::string page(const SensorAccuracy& other) {
  SensorEffects effects{clean(), {other}, {14.0}, 100, 3};
  effects.clean.sensor.name = "thesis";
  effects.others[0].sensor.name = "other";
  return page_text("sensor_effects", sensor_effects_page(effects, "the command"));
}

TEST(SensorEffectsReport, SentencesFollowTheFigures) {
  SensorAccuracy other = clean();
  EXPECT_THAT(page(other),
              HasSubstr("\n\n## other\n\nAgainst thesis: no difference.\n\n"
                        "Rmse: higher in 0 of 4 comparisons, lower in 0, the intervals touch in 4.\n"
                        "Share above 3 %: higher in 0 of 4 comparisons, lower in 0, the intervals "
                        "touch in 4.\n"
                        "Outliers: higher in 0 of 4 comparisons, lower in 0, the intervals touch in 4.\n"
                        "Bias before the table: higher in 0 of 4 comparisons, lower in 0, the intervals "
                        "touch in 4.\n"
                        "No read-out's rmse changes beyond the intervals.\n"
                        "Median ratio of the rmse to the clean sensor's over distances and lights: "
                        "lowest for A (1.00), highest for B (1.00).\n\n"
                        "Rmse, % of the distance, 14 klux:\n\n| read-out "));
  other.points[1] = point("A", 2.0, 0.12);
  other.points[2] = point("B", 1.0, 0.01);
  const std::string changed = page(other);
  EXPECT_THAT(changed,
              HasSubstr("Rmse: higher in 1 of 4 comparisons, lower in 1, the intervals touch in 2.\n"));
  EXPECT_THAT(changed,
              HasSubstr("touch in 4.\nThe rmse rises most for A at 2 m and 14 klux: from 2.00 [1.80, 2.20] "
                        "to 6.00 [5.40, 6.60] % of the distance.\nThe rmse falls most for B at 1 m and 14 "
                        "klux: from 5.00 [4.50, 5.50] to 1.00 [0.90, 1.10] % of the distance.\nMedian "));
  EXPECT_THAT(changed, HasSubstr("lowest for B (1.00), highest for A (3.00)"));
  EXPECT_THAT(changed, Not(HasSubstr("No read-out")));
  EXPECT_THAT(changed, Not(HasSubstr("moves most")));
  other.points[3].bias_m = {0.05, {0.04, 0.06}};
  EXPECT_THAT(page(other),
              HasSubstr("The bias before the table moves most for B at 2 m and 14 klux: from 10.0 "
                        "[0.0, 20.0] to 50.0 [40.0, 60.0] mm.\n"));
  EXPECT_THAT(page(other), HasSubstr("Bias before the table: higher in 1 of 4"));
}

TEST(SensorEffectsReport, SaysHowItWasMeasured) {
  EXPECT_THAT(page(clean()), HasSubstr("\n\nEach sensor against the clean one, `thesis`: flat targets of "
                                       "reflectivity 1, 100 frames at each distance and light, seed 3. Every "
                                       "read-out has a look-up table of its own, "));
  EXPECT_THAT(page(clean()), EndsWith("|\n\nAll figures: sensor_effects.csv. Command: `the command`\n"));
}

TEST(SensorEffectsReport, RefusesOtherPoints) {
  SensorAccuracy other = clean();
  other.points.pop_back();
  EXPECT_THROW((void)intervals_apart(clean(), other, &AccuracyPoint::rmse_m), std::logic_error);
  EXPECT_THROW((void)median_rmse_ratio(clean(), clean(), "C"), std::logic_error);
}

TEST(SensorEffectsReport, NamesWhatDiffers) {
  SensorModel sensor;
  EXPECT_EQ(sensor_difference(SensorModel(), sensor), "no difference");
  sensor.dead_time_s = 20e-9;
  sensor.defects.hot_share = 0.01;
  sensor.defects.hot_dark_count_rate_hz = 1e6;
  sensor.tdc_codes = std::make_shared<const TdcCodes>(std::vector<std::vector<double>>{{3.0, 1.0}});
  const std::string text = sensor_difference(SensorModel(), sensor);
  EXPECT_THAT(text, HasSubstr("dead time 20 ns"));
  EXPECT_THAT(text, HasSubstr("1 % and 0 listed hot pixels of 1e+06 Hz"));
  EXPECT_THAT(text, HasSubstr("1 table: the widest code 1.5 T_res, boundaries up to 0.5 T_res"));
}

}  // namespace
}  // namespace dtof
