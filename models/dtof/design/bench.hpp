// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// A scene of the sensor's array, its distances in proportion to the sensor's range: that of the thesis's
/// sensor leaves them as they are.
TargetMap scaled_scene(Scene scene, const SensorModel& sensor, std::uint64_t seed);

/// What read-outs are measured on.
struct BenchSettings {
  SensorModel sensor;
  std::vector<Scene> scenes = {Scene::kRoom, Scene::kPoles};
  std::vector<double> klux = {2.0, 50.0};
  double false_alarms = 1e-3;  ///< of pixels that look at the sky, at most
  std::uint64_t seed = 1;
  int threads = 0;
};

/// A read-out's errors in one light, over all scenes.
struct LightScore {
  double klux = 0.0;
  Estimate above_3_percent;
  Estimate above_10_percent;
  double rmse_m = 0.0;
  /// Pixels that pass the threshold of confidence and are at most 10 % off.
  std::optional<Estimate> detected;
  std::optional<Estimate> false_alarms;  ///< of the sky, with other photons than set the threshold
};

struct ReadoutScore {
  std::vector<LightScore> lights;
  std::uint64_t pixels = 0;      ///< of a frame of all scenes
  std::optional<int> threshold;  ///< of confidence

  /// The light with most pixels that are more than 3 % off.
  [[nodiscard]] const LightScore& worst() const;
};

/// How much is read: pixels of a frame, about, and frames.
struct BenchEffort {
  double pixels = 1e9;
  int frames = 1;
  bool detection = false;
};

/// Columns of the middle of three parts of the array, as many as have so many pixels; all if it has no more.
std::vector<int> bench_columns(const SensorModel& sensor, double pixels);

/// Every read-out's score, of the same photons as far as SLOTS agree; the models read the photons of the
/// exact source, with look-up tables from flat targets. An interval needs at least two frames; of one frame
/// it is that of independent pixels.
std::vector<ReadoutScore> run_bench(const BenchSettings& settings,
                                    std::span<const ReadoutParameters> readouts, const BenchEffort& effort,
                                    Progress* progress = nullptr);

}  // namespace dtof
