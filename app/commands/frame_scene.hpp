// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "command_line/own_cube.hpp"
#include "command_line/own_map.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// Options of `dtof frame` for its scene: a built-in scene, a depth map or a transient cube.
struct FrameScene {
  std::string scene = "room";
  MapFiles maps;
  MapScales map_scales;
  CubeOptions cube;
  SceneParameters parameters;
  std::optional<int> array_columns;
  std::optional<int> array_rows;
  std::optional<double> reflectivity;

  void add_to(CLI::App& command);
  /// Name of the scene, or the file that takes its place.
  [[nodiscard]] std::string name() const;
  /// Throws InputError for options of `command` that contradict each other or have no effect.
  void check(const CLI::App& command) const;
  /// Throws InputError unless the scene's distances are ones that the sensor can measure.
  void check_distances(const SensorModel& sensor) const;
  /// Makes the scene. Throws InputError.
  [[nodiscard]] OwnMap targets(const SensorModel& sensor) const;

 private:
  [[nodiscard]] bool own() const { return !maps.depth.empty() || !cube.file.empty(); }
};

}  // namespace dtof
