// SPDX-License-Identifier: Apache-2.0
#include "frames/standard_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/sensor/preset.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

SensorModel small_sensor(const char* preset, std::uint32_t acquisitions) {
  SensorModel sensor = parse_preset(preset);
  sensor.columns = 34;
  sensor.rows = 16;
  sensor.acquisitions = acquisitions;
  return sensor;
}

StandardFramesSettings small_frames() {
  StandardFramesSettings settings;
  settings.sensors = {small_sensor("thesis", 100), small_sensor("thesis_full", 1000)};
  settings.readouts = {Readout::kHisPointer, Readout::kPoolPointer};
  settings.frames = 2;
  return settings;
}

TEST(StandardFrames, FiguresAreThoseOfTheSceneStudysFrames) {
  const StandardFramesSettings settings = small_frames();
  const std::vector<StandardFrame> frames = run_standard_frames(settings);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[1].readout, Readout::kPoolPointer);
  EXPECT_EQ(frames[2].sensor, "thesis_full");
  EXPECT_EQ(frames[2].pixels, 2U * 34U * 16U);
  const std::vector<ReadoutParameters> readouts = {ReadoutParameters::defaults(Readout::kHisPointer),
                                                   ReadoutParameters::defaults(Readout::kPoolPointer)};
  SceneParameters parameters;
  parameters.columns = 34;
  parameters.rows = 16;
  const StudyScene scene{"room", make_scene(Scene::kRoom, parameters), 34};
  double sum = 0.0;
  const SceneStudy study(settings.sensors[0], 14.0, readouts, 1, 0);
  for (const std::uint32_t n : {0U, 1U}) {
    sum += score_scene(scene_truth(scene), study.measure(scene, n)[1]).all.above_3_percent;
  }
  EXPECT_NE(study.measure(scene, 0)[1].distance_m, study.measure(scene, 1)[1].distance_m);
  EXPECT_GT(sum, 0.0);
  EXPECT_DOUBLE_EQ(frames[1].above_3_percent.value, sum / 2.0);
}

TEST(StandardFrames, TenTimesTheLightIsBetter) {
  const std::vector<StandardFrame> frames = run_standard_frames(small_frames());
  for (const std::size_t readout : {0U, 1U}) {
    EXPECT_LT(frames[2 + readout].above_3_percent.value, 0.7 * frames[readout].above_3_percent.value);
    EXPECT_GE(frames[readout].above_10_percent.interval.low, 0.0);
    EXPECT_GE(frames[readout].found_by_confidence, 0.0);
    EXPECT_LE(frames[readout].found_by_confidence, 1.0);
  }
}

TEST(StandardFrames, ReportHasTheSensorsBesideEachOther) {
  const StandardFramesSettings settings = small_frames();
  std::vector<StandardFrame> frames(4);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].sensor = settings.sensors[i / 2].name;
    frames[i].readout = settings.readouts[i % 2];
    frames[i].above_3_percent = estimate_share(i, 10);
    frames[i].found_by_confidence = i == 0 ? std::nan("") : 0.25;
  }
  const auto page = [&](const std::vector<CheckedFrame>& checked) {
    return page_text("frames", standard_frames_page(settings, frames, checked, "the command"));
  };
  const std::string report = page({{"thesis_full", Readout::kPoolPointer, 34, 16, 1000, 4711}});
  EXPECT_THAT(report,
              StartsWith("# Standard frames\n\nScene room: 34 x 16 pixels, 14 klux, sensor thesis (100 "
                         "acquisitions, 0.3 / R^2 signal events a pulse), thesis_full (1000 acquisitions, "
                         "0.3 / R^2 signal events a pulse); models, exact photons, 2 frames with seed "
                         "1.\n\n## Pixels above 3 %, in % of all\n\n| read-out "));
  EXPECT_THAT(report, HasSubstr("30.00 ("));
  EXPECT_THAT(report,
              EndsWith("RTL with thesis_full: poolPointer, 34 columns of 16 rows, 1000 acquisitions, seed 1: "
                       "every pixel equal to the model, 4711 clocks.\n\nCommand: `the command`\n"));
  EXPECT_THAT(page({}), HasSubstr("pixels.\n\nNo RTL was run.\n\nCommand: "));
  EXPECT_THAT(standard_frames_csv(frames).csv(), HasSubstr("\nthesis,poolpointer,poolPointer,"));
}

TEST(StandardFrames, RefusesWhatGivesNoInterval) {
  const auto refused = [](void (*change)(StandardFramesSettings&), const char* message) {
    StandardFramesSettings settings = small_frames();
    change(settings);
    EXPECT_THAT([&] { run_standard_frames(settings); }, ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refused([](StandardFramesSettings& s) { s.frames = 1; }, "2 frames");
  refused([](StandardFramesSettings& s) { s.readouts.clear(); }, "a read-out");
  refused([](StandardFramesSettings& s) { s.sensors.clear(); }, "a sensor");
}

}  // namespace
}  // namespace dtof
