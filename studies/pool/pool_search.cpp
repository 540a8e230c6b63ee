// SPDX-License-Identifier: Apache-2.0
#include "pool/pool_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/metrics/depth.hpp"

namespace dtof {
namespace {

/// `columns` columns in the middle of a scene, with the truth that they have in the whole one.
StudyScene middle(const StudyScene& scene, int columns, SceneTruth& truth) {
  const int width = scene.targets.columns();
  const int rows = scene.targets.rows();
  if (width < columns) {
    throw InputError(fmt::format("{}: {} columns, but an engine has {}", scene.name, width, columns));
  }
  const int first = (width - columns) / 2;
  const SceneTruth whole = scene_truth({scene.name, scene.targets, width});
  StudyScene part{scene.name, TargetMap(columns, rows), columns};
  truth = {.columns = columns, .rows = rows, .distance_m = {}, .edge = {}, .single = {}};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      part.targets.at(column, row) = scene.targets.at(first + column, row);
      const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(first + column);
      truth.distance_m.push_back(whole.distance_m[i]);
      truth.edge.push_back(whole.edge[i]);
      truth.single.push_back(whole.single[i]);
    }
  }
  return part;
}

/// Logarithm of each figure of DesignScore for a frame.
using Logarithms = std::array<double, 4>;

Logarithms score_frame(const DepthScale& scale, const SensorModel& sensor, const TrainingFrame& frame,
                       const PoolNumbers& design) {
  SceneMeasurement raw;
  SceneMeasurement smooth;
  const std::size_t pixels = frame.truth.distance_m.size();
  const auto width = static_cast<std::size_t>(frame.truth.columns);
  for (SceneMeasurement* measurement : {&raw, &smooth}) {
    measurement->distance_m.resize(pixels);
    measurement->confidence.resize(pixels);
  }
  const auto fraction_bits = static_cast<unsigned>(16 - sensor.np);
  const auto distance = [&](std::int32_t position) {
    return scale.depth(
        code_position(pool_result(position, 0, fraction_bits), static_cast<int>(fraction_bits)));
  };
  std::size_t column = 0;
  for (const std::vector<PoolColumn>& engine : frame.photons.engines) {
    const std::vector<PoolWinners> winners = read_engine(engine, frame.photons.acquisitions, design);
    for (std::size_t i = 0; i < winners.size(); ++i, ++column) {
      const std::vector<std::int32_t> positions =
          smoothed_positions(winners[i], i > 0 ? winners[i - 1] : PoolWinners(), design);
      for (std::size_t row = 0; row < positions.size(); ++row) {
        raw.distance_m[row * width + column] = distance(winners[i][row].position);
        smooth.distance_m[row * width + column] = distance(positions[row]);
      }
    }
  }
  const SceneScore without = score_scene(frame.truth, raw);
  const SceneScore with = score_scene(frame.truth, smooth);
  const auto logarithm = [](double share) { return std::log(100.0 * share + kLeastShare); };
  return {logarithm(without.all.above_3_percent), logarithm(with.all.above_3_percent),
          logarithm(with.all.above_10_percent), logarithm(with.edges.above_3_percent)};
}

}  // namespace

std::vector<TrainingFrame> draw_training_frames(const SensorModel& sensor,
                                                const std::vector<StudyScene>& scenes,
                                                const std::vector<double>& klux, std::uint64_t seed,
                                                int columns, int threads) {
  std::vector<TrainingFrame> frames(scenes.size() * klux.size());
  parallel_for(frames.size(), threads, [&](std::size_t i) {
    const StudyScene& scene = scenes[i / klux.size()];
    TrainingFrame& frame = frames[i];
    frame.scene = scene.name;
    frame.klux = klux[i % klux.size()];
    const StudyScene part = middle(scene, columns, frame.truth);
    frame.photons = draw_pool_frame(sensor, part.targets, frame.klux, seed, scene_frame(0), columns, 1);
  });
  return frames;
}

double DesignScore::objective() const {
  return std::pow(above_3_percent * smooth_above_3_percent * above_10_percent * edges_above_3_percent, 0.25);
}

DesignScore score_design(const SensorModel& sensor, const std::vector<TrainingFrame>& frames,
                         const PoolNumbers& design, int threads) {
  const DepthScale scale(sensor.integration_time_s, sensor.np, sensor.pulse_fwhm_s);
  std::vector<Logarithms> scores(frames.size());
  parallel_for(frames.size(), threads,
               [&](std::size_t i) { scores[i] = score_frame(scale, sensor, frames[i], design); });
  std::array<double, 4> mean{};
  std::map<double, std::pair<double, int>> lights;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    auto& [sum, count] = lights[frames[i].klux];
    ++count;
    for (std::size_t f = 0; f < mean.size(); ++f) {
      mean[f] += scores[i][f] / static_cast<double>(frames.size());
      sum += scores[i][f] / static_cast<double>(mean.size());
    }
  }
  DesignScore score{std::exp(mean[0]), std::exp(mean[1]), std::exp(mean[2]), std::exp(mean[3]), {}};
  for (const auto& [klux, light] : lights) {
    score.by_light.push_back(std::exp(light.first / light.second));
  }
  return score;
}

}  // namespace dtof
