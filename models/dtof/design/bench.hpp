// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/pipeline/region.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// A scene for the sensor's array. Distances are scaled by the ratio of the sensor's range to that of the
/// thesis's sensor.
TargetMap scaled_scene(Scene scene, const SensorModel& sensor, std::uint64_t seed);

/// Photons and limits of a comparison of read-outs.
struct BenchSettings {
  SensorModel sensor;
  std::vector<Scene> scenes = {Scene::kRoom, Scene::kPoles};
  std::vector<double> klux = {2.0, 50.0};
  /// Largest share of pixels without a target that may pass the confidence threshold.
  double false_alarms = 1e-3;
  std::uint64_t seed = 1;
  int threads = 0;
};

/// Errors of a read-out at one light level, over all scenes.
struct LightScore {
  double klux = 0.0;
  Estimate above_3_percent;
  std::vector<double> above_3_of_frames;  ///< share of each frame's pixels, in the order of the frames
  Estimate above_10_percent;
  double rmse_m = 0.0;
  /// Share of pixels that pass the confidence threshold and are at most 10 % off.
  std::optional<Estimate> detected;
  std::optional<Estimate> false_alarms;  ///< share of sky pixels that pass the threshold, from other photons
                                         ///< than those that set it
};

struct ReadoutScore {
  std::vector<LightScore> lights;
  std::uint64_t pixels = 0;      ///< pixels of one frame of all scenes together
  std::optional<int> threshold;  ///< least confidence of a target

  /// The light level with the largest share of errors above 3 %.
  [[nodiscard]] const LightScore& worst() const;
};

/// Size of a measurement: approximate number of pixels of a frame, and number of frames.
struct BenchEffort {
  double pixels = 1e9;
  int frames = 1;
  bool detection = false;
  int engine_columns = 1;  ///< pixels are those of whole engines of so many columns
};

/// Returns the number of frames to read: `frames`, or more if the frames of all scenes would have fewer than
/// 4,000 pixels together, because the share of so few pixels does not show a per cent.
int bench_frames(const BenchSettings& settings, int frames);

/// Columns of an engine for BenchEffort: the fewest that the pool read-outs among these have by default; 1
/// without any.
int bench_engine_columns(std::span<const ReadoutParameters> readouts);

/// Returns up to three groups of columns, near the middles of equal parts of the array, that hold about
/// `pixels` pixels together; all columns if the array has no more. Each group has whole engines of
/// `engine_columns` columns, at least one: a model reads an engine's columns together. There are as many
/// groups as fit `pixels`, at least one.
std::vector<int> bench_columns(const SensorModel& sensor, double pixels, int engine_columns = 1);

/// Returns the columns of bench_columns, and of these all rows or, if they have more than `pixels` pixels,
/// rows in the middle: a multiple of 32, at least 64.
Region bench_region(const SensorModel& sensor, double pixels, int engine_columns);

/// Look-up tables from flat targets, by light and read-out. A comparison in further frames needs no new
/// ones. Not for several threads at once.
class BenchTables {
 public:
  /// The tables of these read-outs, in order; fits those that are not yet there. The sensor, but for its
  /// SLOTS, the seed and the number of threads are the same at each call.
  [[nodiscard]] std::vector<RangeConverter> of(const SensorModel& sensor, double klux,
                                               std::span<const ReadoutParameters> readouts,
                                               const BenchSettings& settings);

 private:
  struct Entry {
    double klux = 0.0;
    ReadoutParameters readout;
    RangeConverter table;
  };
  std::vector<Entry> entries_;
};

/// Returns the read-outs without repetitions, in order.
std::vector<ReadoutParameters> distinct_readouts(std::span<const ReadoutParameters> readouts);

/// Returns the score of every read-out; equal ones are read once. Read-outs with equal SLOTS get the same
/// photons. The models read the exact photon source and use look-up tables from flat targets, which are taken
/// from `tables`, if given, or added there. Intervals need at least two frames; with one frame they assume
/// independent pixels.
std::vector<ReadoutScore> run_bench(const BenchSettings& settings,
                                    std::span<const ReadoutParameters> readouts, const BenchEffort& effort,
                                    Progress* progress = nullptr, BenchTables* tables = nullptr);

}  // namespace dtof
