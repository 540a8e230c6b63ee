// SPDX-License-Identifier: Apache-2.0
#include "playground/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

constexpr int kOneThread = 1;

void require_in_range(const SensorModel& sensor, double metres) {
  if (metres >= sensor_range_m(sensor)) {
    throw InputError(fmt::format("{} m is beyond {}", metres, range_phrase(sensor)));
  }
}

TargetMap make_targets(const PlaygroundRequest& request, const SensorModel& sensor) {
  const Scene scene = parse_scene(request.scene);
  if (scene == Scene::kFlat) {
    require_in_range(sensor, request.distance_m);
  } else if (scene == Scene::kStaircase || scene == Scene::kPlane) {
    require_in_range(sensor, request.near_m);
    require_in_range(sensor, request.far_m);
  }
  SceneParameters parameters;
  parameters.columns = request.columns.value_or(sensor.columns);
  parameters.rows = request.rows.value_or(sensor.rows);
  parameters.distance_m = request.distance_m;
  parameters.near_m = request.near_m;
  parameters.far_m = request.far_m;
  parameters.steps = request.steps;
  parameters.reflectivity = request.reflectivity.value_or(sensor.default_reflectivity);
  return make_scene(scene, parameters);
}

PhotonSource make_photons(const PlaygroundRequest& request, const PlaygroundFiles& files) {
  SensorModel sensor = files.sensor_text.empty() ? parse_preset(request.sensor)
                                                 : parse_sensor(files.sensor_text, files.sensor_name);
  sensor.acquisitions = request.acquisitions.value_or(sensor.acquisitions);
  const TargetMap targets =
      files.map_columns == 0
          ? make_targets(request, sensor)
          : scene_from_depth_image(files.map_columns, files.map_rows, files.map_m,
                                   request.columns.value_or(sensor.columns),
                                   request.rows.value_or(sensor.rows),
                                   request.reflectivity.value_or(sensor.default_reflectivity));
  return {sensor, targets, request.klux, request.seed};
}

FramePipeline make_pipeline(PhotonSource photons, const FrameEngine& engine, std::uint64_t seed) {
  const Region region = Region::whole(photons.columns(), photons.rows());
  return {std::move(photons), engine, {.region = region, .seed = seed, .threads = kOneThread}};
}

}  // namespace

PlaygroundSession::PlaygroundSession(const PlaygroundRequest& request, const PlaygroundFiles& files)
    : engine_({.threads = kOneThread, .observer = [](std::size_t, std::size_t) {}}),
      pipeline_(make_pipeline(make_photons(request, files), engine_, request.seed)) {
  for (int row = 0; row < rows(); ++row) {
    for (const int column : pipeline_.region().columns) {
      reflectivity_.push_back(static_cast<float>(pipeline_.scene().targets().at(column, row).reflectivity));
    }
  }
  for (const std::string& name : request.readouts) {
    readouts_.push_back(default_parameters(parse_readout(name), pipeline_.scene().model()));
  }
  read_.resize(readouts_.size());
  results_.assign(readouts_.size(), std::vector<PixelResult>(truth_m().size()));
}

void PlaygroundSession::calibrate() { tabled_ = pipeline_.tables(readouts_, TableRule::kFlat); }

void PlaygroundSession::read_column(int column) {
  const auto width = static_cast<std::size_t>(columns());
  for (std::size_t r = 0; r < readouts_.size(); ++r) {
    if ((column + 1) % readouts_[r].columns_together() != 0 && column + 1 < columns()) {
      continue;
    }
    std::vector<int> together(static_cast<std::size_t>(column + 1 - read_[r]));
    std::iota(together.begin(), together.end(), read_[r]);
    const std::size_t first = static_cast<std::size_t>(read_[r]);
    const std::size_t count = together.size();
    const std::vector<PixelResult> results = pipeline_.read(readouts_[r], std::move(together)).results;
    for (std::size_t i = 0; i < results.size(); ++i) {
      results_[r][i / count * width + first + i % count] = results[i];
    }
    read_[r] = column + 1;
  }
  // A page has little memory.
  for (const int all_read = std::ranges::min(read_); forgotten_ < all_read; ++forgotten_) {
    pipeline_.forget_photons(forgotten_);
  }
}

PlaygroundFrame PlaygroundSession::frame(std::size_t readout) const {
  PlaygroundFrame frame;
  frame.results = results_.at(readout);
  FrameMaps maps = pipeline_.judge(frame.results, tabled_.at(readout));
  frame.figures = figure_values(maps.figures, true);
  frame.depth_m = std::move(maps.depth);
  frame.error_m = std::move(maps.error);
  return frame;
}

std::vector<Detection> PlaygroundSession::pixel(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns() || row >= rows()) {
    throw InputError(fmt::format("there is no pixel in column {}, row {}", column, row));
  }
  const ColumnStream stream = pipeline_.scene().column(column);
  const auto detections = stream.row(row);
  return {detections.begin(), detections.end()};
}

int PlaygroundSession::codes() const { return 1 << pipeline_.scene().model().np; }

}  // namespace dtof
