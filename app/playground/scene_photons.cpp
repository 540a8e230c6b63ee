// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/frame/frame_truth.hpp"
#include "dtof/pipeline/frame_pipeline.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"
#include "playground/photons.hpp"
#include "playground/session.hpp"

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
  SensorModel sensor = playground_sensor(request, files);
  sensor.acquisitions = request.acquisitions.value_or(sensor.acquisitions);
  const TargetMap targets =
      files.map_columns == 0
          ? make_targets(request, sensor)
          : scene_from_depth_image(files.map_columns, files.map_rows, files.map_m,
                                   request.columns.value_or(sensor.columns),
                                   request.rows.value_or(sensor.rows),
                                   request.reflectivity.value_or(sensor.default_reflectivity));
  if (files.map_columns != 0) {
    require_reachable(targets, sensor, files.map_name);
  }
  return {sensor, targets, request.klux, request.seed};
}

FramePipeline make_pipeline(PhotonSource photons, const FrameEngine& engine, std::uint64_t seed) {
  const Region region = Region::whole(photons.columns(), photons.rows());
  return {std::move(photons), engine, {.region = region, .seed = seed, .threads = kOneThread}};
}

class ScenePhotons final : public PlaygroundPhotons {
 public:
  ScenePhotons(const PlaygroundRequest& request, const PlaygroundFiles& files, const FrameEngine& engine)
      : pipeline_(make_pipeline(make_photons(request, files), engine, request.seed)) {}

  [[nodiscard]] const StreamSource& source() const override { return pipeline_.scene(); }
  [[nodiscard]] const SensorModel& sensor() const override { return pipeline_.scene().model(); }
  [[nodiscard]] const std::vector<float>& truth_m() const override { return pipeline_.truth().metres; }
  [[nodiscard]] std::vector<float> brightness() const override {
    std::vector<float> reflectivity;
    for (int row = 0; row < pipeline_.scene().rows(); ++row) {
      for (const int column : pipeline_.region().columns) {
        reflectivity.push_back(static_cast<float>(pipeline_.scene().targets().at(column, row).reflectivity));
      }
    }
    return reflectivity;
  }

  void calibrate(std::span<const ReadoutParameters> readouts) override {
    tabled_ = pipeline_.tables(readouts, TableRule::kFlat);
  }
  [[nodiscard]] std::vector<PixelResult> read(const ReadoutParameters& readout,
                                              std::vector<int> columns) const override {
    return pipeline_.read(readout, std::move(columns)).results;
  }
  void drop(int column) override { pipeline_.drop_photons(column); }
  [[nodiscard]] FrameMaps judge(std::span<const PixelResult> results, std::size_t readout) const override {
    return pipeline_.judge(results, tabled_.at(readout));
  }

 private:
  FramePipeline pipeline_;
  std::vector<TabledReadout> tabled_;
};

}  // namespace

SensorModel playground_sensor(const PlaygroundRequest& request, const PlaygroundFiles& files) {
  return files.sensor_text.empty() ? parse_preset(request.sensor)
                                   : parse_sensor(files.sensor_text, files.sensor_name);
}

std::unique_ptr<PlaygroundPhotons> make_scene_photons(const PlaygroundRequest& request,
                                                      const PlaygroundFiles& files,
                                                      const FrameEngine& engine) {
  return std::make_unique<ScenePhotons>(request, files, engine);
}

}  // namespace dtof
