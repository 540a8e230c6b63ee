// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "command_line/own_map.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// Scenes that a study reads.
struct SceneChoice {
  std::vector<std::string> scenes = {"flat", "room", "planes", "clutter", "poles", "isolated"};
  std::vector<std::string> maps;
  MapScales map_scales;
  std::string disparity_file;
  double nearest_m = 1.0;
  std::vector<std::string> photographed;  ///< NAME=DISPARITY,PHOTOGRAPH
  std::string surface_file;
  std::string surface_variable = "T_second";
  bool held_out = false;
  double distance_scale = 1.0;  ///< factor for all distances, for sensors with another range
  int columns = 200;
  std::uint64_t seed = 1;
};

/// Adds the options that select scenes: --scene, --map and its scales, --disparity, --nearest, --surface,
/// --variable, --held-out and --distance-scale.
void add_scene_options(CLI::App& command, SceneChoice& choice);
/// Completes `choice` after parsing: if only own maps are given, no other scene is read. Throws InputError
/// for options without effect.
void check_scene_options(const CLI::App& command, SceneChoice& choice);

/// Scenes of a study, and sentences on the resampling of maps.
struct SceneList {
  std::vector<StudyScene> scenes;
  std::vector<std::string> notes;

  void add_map(const std::string& name, const std::string& note, TargetMap targets, int columns) {
    scenes.push_back({name, std::move(targets), columns});
    notes.push_back(fmt::format("Scene {}: {}", name, note));
  }
};

/// Least reflectivity in a photographed map, relative to the sensor's default.
inline constexpr double kDarkestPhotographed = 0.05;

SceneList make_scenes(const SceneChoice& options, const SensorModel& sensor);

}  // namespace dtof
