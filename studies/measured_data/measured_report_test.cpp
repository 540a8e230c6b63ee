// SPDX-License-Identifier: Apache-2.0
#include "measured_data/measured_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace dtof {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

MeasuredOutcome outcome(double share) {
  MeasuredOutcome outcome{{}, {}, {}, 0.01 * share, 0.3 * share};
  outcome.score.all.above_3_percent = 0.2 * share;
  outcome.score.all.above_10_percent = 0.1 * share;
  outcome.score.removed = {0.0, 0.0, share < 1.0 ? std::nan("") : 0.25, 0.0, 0.0, 0.0, 0.0};
  outcome.errors.rmse_m = 0.4 * share;
  outcome.errors.bias_m = -0.02 * share;
  return outcome;
}

MeasuredResults results() {
  return {
      .readouts = {"ezPointer", "SiFH"},
      .lights = {{{0.0, 0.0}, {outcome(1.0), outcome(0.5)}}, {{25.0, 0.15}, {outcome(2.0), outcome(1.0)}}},
      .acquisitions = 3333,
      .t_int_ns = 45.0,
      .timestamp_bits = 10,
      .frames = 4,
      .seed = 9,
      .compared_with_rtl = {.equal = {"ezPointer"}, .not_compiled = {"SiFH"}},
      .command_line = "the command"};
}

MeasuredScene scene(TruthOrigin origin) {
  MeasuredScene scene;
  scene.title = "The title";
  scene.columns = 26;
  scene.rows = 16;
  scene.truth.origin = origin;
  return scene;
}

std::string page_of(const MeasuredScene& scene) {
  return page_text("measured", measured_page(scene, results()));
}

TEST(MeasuredReport, ThePageOfTwoSurfaces) {
  MeasuredScene surfaces = scene(TruthOrigin::kSurface);
  surfaces.mean_photons = 50.84;
  surfaces.other_m = {1.0};
  EXPECT_EQ(page_of(surfaces), R"(# The title

Photon arrival times, 26 x 16 pixels, 50.8 photons per pixel in the mean. Truth: of the two surfaces, estimated from all photons, the one from which more of the pixel's photons come. The photons are thinned to the mean number per pixel and frame that each table names, and resampled to 3333 acquisitions of 45 ns with timestamps of 10 bits. Frames of each light: 4. Background: events that are added per acquisition (preset `thesis`: 0.15 at 14 klux, 0.54 at 50 klux). The constant offset of each read-out, its median difference to the truth in the first light, is subtracted. Seed 9.

Pixels with an error above 3 % / 10 %, in %:

| light                       |   ezPointer |        SiFH |
|-----------------------------|------------:|------------:|
| all photons                 | 20.0 / 10.0 |  10.0 / 5.0 |
| 25 photons, 0.15 background | 40.0 / 20.0 | 20.0 / 10.0 |

Pixels that are more than 3 % off both surfaces, in %:

| light                       | ezPointer | SiFH |
|-----------------------------|----------:|-----:|
| all photons                 |      30.0 | 15.0 |
| 25 photons, 0.15 background |      60.0 | 30.0 |

Rmse / bias, mm:

| light                       | ezPointer |      SiFH |
|-----------------------------|----------:|----------:|
| all photons                 | 400 / -20 | 200 / -10 |
| 25 photons, 0.15 background | 800 / -40 | 400 / -20 |

Median error, mm:

| light                       | ezPointer | SiFH |
|-----------------------------|----------:|-----:|
| all photons                 |        10 |    5 |
| 25 photons, 0.15 background |        20 |   10 |

Outliers (errors above 10 %) that are removed with the 5 % of the pixels that have the lowest confidence, in % of all outliers:

| light                       | ezPointer | SiFH |
|-----------------------------|----------:|-----:|
| all photons                 |      25.0 |    - |
| 25 photons, 0.15 background |      25.0 | 25.0 |

RTL equal to the model in each of 26 x 16 pixels: ezPointer. Not compiled as RTL for 16 rows: SiFH.

Command: `the command`
)");
  surfaces.from_tick = 5200.0;
  surfaces.other_m.clear();
  const std::string behind = page_of(surfaces);
  EXPECT_THAT(behind,
              HasSubstr("50.8 photons per pixel in the mean after tick 5200; earlier ones are left out. "
                        "Truth: of the two surfaces,"));
  EXPECT_THAT(behind, Not(HasSubstr("both surfaces")));
}

TEST(MeasuredReport, SaysWhereTheTrueDistancesComeFrom) {
  const auto beginning = [](TruthOrigin origin) {
    MeasuredScene recording = scene(origin);
    recording.contents = "a log, 26 frames";
    recording.truth.window_s = 2e-9;
    recording.truth.without_return = 1;
    recording.truth.map = "map.png";
    return page_of(recording);
  };
  const std::string before = "# The title\n\nRecording (a log, 26 frames) of 26 x 16 pixels. ";
  EXPECT_THAT(
      beginning(TruthOrigin::kStrongestReturn),
      StartsWith(before + "Truth: the strongest return of each pixel, the mean time of the photons in the "
                          "window of 2 ns that has most of the pixel's photons. Pixels left out because they "
                          "have no return: 1. The photons are thinned to"));
  EXPECT_THAT(
      beginning(TruthOrigin::kPlane),
      StartsWith(before +
                 "Truth: the known distance of the plane in each capture. The photons are thinned to"));
  EXPECT_THAT(
      beginning(TruthOrigin::kSensor),
      StartsWith(before + "Truth: the distance that the sensor itself reported. The photons are thinned to"));
  EXPECT_THAT(beginning(TruthOrigin::kMap),
              StartsWith(before + "The truth is the map map.png. The photons are thinned to"));
}

TEST(MeasuredReport, SaysWhatIsLeftOut) {
  MeasuredScene log = scene(TruthOrigin::kSensor);
  log.contents = "a log";
  log.is_tmf8829 = true;
  log.truth.range_m = 4.497;
  log.truth.beyond_range = 3;
  EXPECT_THAT(
      page_of(log),
      HasSubstr("of 26 x 16 pixels. If the log has histograms of the sensor's row 0 only, as the published "
                "one has, each frame is a column here and the zones of row 0 are its rows: read-outs that "
                "pool pixels need neighbours in a column. Truth: the distance that the sensor itself "
                "reported. Pixels left out because they are beyond the range, 4.50 m: 3. The photons are "
                "thinned to"));
  MeasuredResults none = results();
  none.compared_with_rtl = {.equal = {}, .not_compiled = {"ezPointer", "SiFH"}};
  EXPECT_THAT(
      page_text("measured", measured_page(log, none)),
      HasSubstr(
          "in each of 26 x 16 pixels: none compiled. Not compiled as RTL for 16 rows: ezPointer, SiFH."));
  none.compared_with_rtl = {.equal = {"ezPointer", "SiFH"}, .not_compiled = {}};
  EXPECT_THAT(page_text("measured", measured_page(log, none)),
              EndsWith("in each of 26 x 16 pixels: ezPointer, SiFH.\n\nCommand: `the command`\n"));
}

}  // namespace
}  // namespace dtof
