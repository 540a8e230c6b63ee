// SPDX-License-Identifier: Apache-2.0
#include "rivals/rival_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;

/// A made-up rival that asks for three frames: its position is the number of the last one's detections, its
/// confidence that of the one before.
class CountingRival final : public Rival {
 public:
  explicit CountingRival(bool tells) : tells_(tells) {}
  [[nodiscard]] int bits_per_pixel() const override { return 7; }
  [[nodiscard]] RivalHardware hardware() const override { return {.word_bits = 7}; }
  [[nodiscard]] int host_operations() const override { return 0; }
  [[nodiscard]] int frames() const override { return 3; }
  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    return {static_cast<std::int32_t>(frames[1].size()), static_cast<std::int32_t>(frames[2].size())};
  }
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return {static_cast<double>(words[1]), static_cast<double>(words[0])};
  }
  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const override {
    if (!tells_) {
      return {};
    }
    std::vector<double> scores(1023, 0.0);
    scores[static_cast<std::size_t>(words[1] % 1023)] = 1.0;
    return scores;
  }

 private:
  bool tells_;
};

/// Position: detections of a frame; confidence: those of a frame before it, without laser light.
class BackgroundRival final : public Rival {
 public:
  [[nodiscard]] int bits_per_pixel() const override { return 7; }
  [[nodiscard]] RivalHardware hardware() const override { return {.word_bits = 7}; }
  [[nodiscard]] int host_operations() const override { return 0; }
  [[nodiscard]] int frames() const override { return 2; }
  [[nodiscard]] int laser_off_frames() const override { return 1; }
  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    return {static_cast<std::int32_t>(frames[0].size()), static_cast<std::int32_t>(frames[1].size())};
  }
  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return {static_cast<double>(words[1]), static_cast<double>(words[0])};
  }
};

SensorModel short_frames() {
  SensorModel sensor = find_sensor("thesis");
  sensor.acquisitions = 600;
  return sensor;
}

TEST(RunningMedian, TakesFewerNeighboursAtTheEnds) {
  EXPECT_THAT(running_median(std::vector<double>{1.0, 9.0, 2.0, 3.0, 4.0}, 1),
              ElementsAre(9.0, 2.0, 3.0, 3.0, 4.0));
  EXPECT_THAT(running_median(std::vector<double>{5.0}, 2), ElementsAre(5.0));
}

TEST(RivalStudy, SeesThePhotonsOfTheSceneAndOtherFramesBefore) {
  const std::vector<RivalEntry> entries = {
      {"counting", "counting", "made up",
       [](const SensorModel&) -> std::unique_ptr<Rival> { return std::make_unique<CountingRival>(false); }}};
  const SensorModel sensor = short_frames();
  const StudyScene scene{"wall", TargetMap(3, 5, {2.0, 1.0}), 3};
  const RivalStudy study(sensor, 14.0, entries, true, 7, 1, TableRule::kNone);
  EXPECT_THAT(study.estimators(), ElementsAre("counting", "counting, pooled"));
  EXPECT_EQ(study.rival(1).bits_per_pixel(), 7);
  const std::vector<SceneMeasurement> measured = study.measure(scene);
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  const PhotonSource now(sensor, scene.targets, 14.0, 7, scene_frame(0));
  const PhotonSource before(sensor, scene.targets, 14.0, 7, 2);
  for (std::size_t column = 0; column < 3; ++column) {
    std::vector<double> counts;
    for (int row = 0; row < 5; ++row) {
      const std::size_t i = static_cast<std::size_t>(row) * 3 + column;
      counts.push_back(static_cast<double>(now.column(static_cast<int>(column)).row(row).size()));
      EXPECT_DOUBLE_EQ(measured[0].distance_m[i], scale.depth(counts.back()));
      EXPECT_EQ(measured[0].confidence[i],
                static_cast<double>(before.column(static_cast<int>(column)).row(row).size()));
    }
    const std::vector<double> middle = running_median(counts, 2);
    for (std::size_t row = 0; row < 5; ++row) {
      EXPECT_DOUBLE_EQ(measured[1].distance_m[row * 3 + column], scale.depth(middle[row]));
    }
  }
}

// 600 acquisitions at 1 m have 180 events of the pulse; in the dark the SPAD has 0.3.
TEST(RivalStudy, TakesTheFirstFramesWithoutLaserLight) {
  const std::vector<RivalEntry> entries = {
      {"background", "background", "made up",
       [](const SensorModel&) -> std::unique_ptr<Rival> { return std::make_unique<BackgroundRival>(); }}};
  const SensorModel sensor = short_frames();
  const StudyScene scene{"wall", TargetMap(2, 4, {1.0, 1.0}), 2};
  const RivalStudy study(sensor, 0.0, entries, false, 7, 1, TableRule::kNone);
  const SceneMeasurement measured = study.measure(scene)[0];
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  for (std::size_t pixel = 0; pixel < measured.distance_m.size(); ++pixel) {
    EXPECT_GT(measured.distance_m[pixel], scale.depth(100.0));
    EXPECT_LT(measured.confidence[pixel], 10.0);
  }
}

TEST(RivalStudy, EqualWhateverTheThreadsAndPoolingHelps) {
  const std::vector<RivalEntry> entries = {find_rival("histogram32")};
  const StudyScene scene{"wall", TargetMap(4, 80, {4.0, 1.0}), 4};
  const SensorModel sensor = short_frames();
  const RivalStudy one(sensor, 50.0, entries, true, 3, 1);
  const RivalStudy two(sensor, 50.0, entries, true, 3, 2);
  const std::vector<SceneMeasurement> measured = one.measure(scene);
  const std::vector<SceneMeasurement> again = two.measure(scene);
  ASSERT_EQ(measured.size(), 2U);
  for (std::size_t e = 0; e < measured.size(); ++e) {
    EXPECT_EQ(measured[e].distance_m, again[e].distance_m);
  }
  const SceneTruth truth = scene_truth(scene);
  const double alone = score_scene(truth, measured[0]).all.above_10_percent;
  EXPECT_GT(alone, 0.1);
  EXPECT_LT(score_scene(truth, measured[1]).all.above_10_percent, 0.5 * alone);
}

// The histogram over the whole frame needs fewer bits than hisPointer, whose coarse peak has half of it.
TEST(RivalStudy, TheWholeFrameFindsWhatHalfOfItLoses) {
  const StudyScene scene{"wall", TargetMap(4, 80, {3.0, 1.0}), 4};
  const SensorModel sensor = short_frames();
  const std::vector<ReadoutParameters> readouts = {ReadoutParameters::defaults(Readout::kHisPointer)};
  const SceneStudy his_pointer(sensor, 14.0, readouts, 3, 1);
  const RivalStudy rival(sensor, 14.0, std::vector<RivalEntry>{find_rival("histogram32")}, false, 3, 1);
  const SceneTruth truth = scene_truth(scene);
  EXPECT_LT(score_scene(truth, rival.measure(scene)[0]).all.above_10_percent,
            0.5 * score_scene(truth, his_pointer.measure(scene)[0]).all.above_10_percent);
}

}  // namespace
}  // namespace dtof
