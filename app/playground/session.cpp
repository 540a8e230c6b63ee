// SPDX-License-Identifier: Apache-2.0
#include "playground/session.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/frame/array_rows.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_maps.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/readout/model.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

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

}  // namespace

PlaygroundSession::PlaygroundSession(const PlaygroundRequest& request, const PlaygroundFiles& files)
    : scene_(make_photons(request, files)), seed_(request.seed) {
  std::vector<int> columns(static_cast<std::size_t>(scene_.columns()));
  std::iota(columns.begin(), columns.end(), 0);
  truth_ =
      frame_truth(scene_.targets(), scene_.model(), columns, {.first = 0, .count = scene_.rows()}).metres;
  for (int row = 0; row < rows(); ++row) {
    for (const int column : columns) {
      reflectivity_.push_back(static_cast<float>(scene_.targets().at(column, row).reflectivity));
    }
  }
  for (const std::string& name : request.readouts) {
    readouts_.push_back(default_parameters(parse_readout(name), scene_.model()));
  }
  waiting_.resize(readouts_.size());
  results_.assign(readouts_.size(), std::vector<PixelResult>(truth_.size()));
}

void PlaygroundSession::calibrate() {
  constexpr int kOneThread = 1;
  const FlatCalibration calibration(scene_.model());
  tables_ = calibration.fit(
      [&](const TargetMap& targets) {
        return std::make_unique<PhotonSource>(scene_.model(), targets, scene_.klux(), seed_,
                                              FlatCalibration::kFrame);
      },
      readouts_, seed_, kOneThread);
}

void PlaygroundSession::read_column(int column) {
  const auto rows = static_cast<std::size_t>(scene_.rows());
  const ColumnStream stream = scene_.column(column);
  for (std::size_t r = 0; r < readouts_.size(); ++r) {
    // Arrays of pool read-outs may have more rows than the sensor.
    const ArrayRows array = array_rows(scene_, {.first = 0, .count = scene_.rows()}, readouts_[r].readout);
    std::vector<ColumnStream>& waiting = waiting_[r];
    waiting.push_back(array.source->rows() == scene_.rows() ? stream : array.source->column(column));
    if (static_cast<int>(waiting.size()) < readouts_[r].columns_together() && column + 1 < scene_.columns()) {
      continue;
    }
    const auto results = make_readout_model(readouts_[r])->run_columns(waiting, scene_.acquisitions());
    const std::size_t first = static_cast<std::size_t>(column) + 1 - results.size();
    for (std::size_t i = 0; i < results.size(); ++i) {
      for (std::size_t row = 0; row < rows; ++row) {
        results_[r][row * static_cast<std::size_t>(scene_.columns()) + first + i] =
            results[i][static_cast<std::size_t>(array.region.first) + row];
      }
    }
    waiting.clear();
  }
}

PlaygroundFrame PlaygroundSession::frame(std::size_t readout) const {
  PlaygroundFrame frame;
  frame.results = results_.at(readout);
  FrameMaps maps =
      frame_maps(frame.results, readouts_.at(readout), scene_.model(), tables_.at(readout), truth_);
  frame.figures = figure_values(maps.figures, true);
  frame.depth_m = std::move(maps.depth);
  frame.error_m = std::move(maps.error);
  return frame;
}

std::vector<Detection> PlaygroundSession::pixel(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns() || row >= rows()) {
    throw InputError(fmt::format("there is no pixel in column {}, row {}", column, row));
  }
  const ColumnStream stream = scene_.column(column);
  const auto detections = stream.row(row);
  return {detections.begin(), detections.end()};
}

int PlaygroundSession::codes() const { return 1 << scene_.model().np; }

}  // namespace dtof
