// SPDX-License-Identifier: Apache-2.0
#include "commands/frame_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "dtof/core/error.hpp"
#include "dtof/frame/frame_truth.hpp"

namespace dtof {
namespace {

/// "flat, staircase, ..."
std::string scene_names() {
  std::vector<std::string_view> names;
  names.reserve(kAllScenes.size());
  for (const Scene scene : kAllScenes) {
    names.push_back(scene_name(scene));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void FrameScene::add_to(CLI::App& command) {
  auto* group = command.add_option_group("scene");
  group->add_option("--scene", scene, scene_names())->capture_default_str();
  group->add_option(
      "--depth", maps.depth,
      "depth map instead of a scene: PNG of 8 or 16 bits, PFM or NPY (rows, columns), resampled\n"
      "to the array by nearest neighbour");
  group->add_option("--reflectivity-map", maps.reflectivity,
                    "reflectivity of each pixel, for a scene or a depth map: PNG, PFM or NPY of any size");
  map_scales.add_to(*group);
  cube.add_to(*group);
  group->add_option("--array-columns", array_columns, "columns of the array (default: the sensor's)")
      ->check(CLI::Range(1, 4096));
  group
      ->add_option("--array-rows", array_rows, "rows of the array, pixels per column (default: the sensor's)")
      ->check(CLI::Range(1, 4096));
  group->add_option("--distance", parameters.distance_m, "flat: distance in m")->capture_default_str();
  group->add_option("--near", parameters.near_m, "staircase, plane: near end in m")->capture_default_str();
  group->add_option("--far", parameters.far_m, "staircase, plane: far end in m")->capture_default_str();
  group->add_option("--steps", parameters.steps, "staircase: steps")->capture_default_str();
  group->add_option("--reflectivity", reflectivity, "reflectivity of every surface (default: the sensor's)")
      ->check(sensible_reflectivity());
}

std::string FrameScene::name() const {
  return !cube.file.empty() ? cube.file : !maps.depth.empty() ? maps.depth : scene;
}

void FrameScene::check(const CLI::App& command) const {
  if (!maps.depth.empty() && !cube.file.empty()) {
    throw InputError("--depth and --cube contradict each other: choose one");
  }
  cube.check();
  if (maps.depth.empty() && map_scales.metres_per_unit) {
    throw InputError("--depth-scale needs --depth");
  }
  if (maps.reflectivity.empty() && map_scales.reflectivity_per_unit) {
    throw InputError("--reflectivity-scale needs --reflectivity-map");
  }
  if (!maps.reflectivity.empty() && reflectivity) {
    throw InputError("--reflectivity and --reflectivity-map contradict each other: choose one");
  }
  if (own()) {
    refuse_without_effect(command, "--scene",
                          fmt::format("{} takes its place", cube.file.empty() ? "--depth" : "--cube"));
  }
  if (own() || scene != "flat") {
    refuse_without_effect(command, "--distance", "only --scene flat has one distance");
  }
  if (own() || (scene != "staircase" && scene != "plane")) {
    refuse_without_effect(command, "--near", "only --scene staircase and plane have a near and a far end");
    refuse_without_effect(command, "--far", "only --scene staircase and plane have a near and a far end");
  }
  if (own() || scene != "staircase") {
    refuse_without_effect(command, "--steps", "only --scene staircase has steps");
  }
}

void FrameScene::check_distances(const SensorModel& sensor) const {
  if (own()) {
    return;
  }
  if (scene == "flat") {
    SensorOptions::require_in_range(sensor, parameters.distance_m, "--distance");
  } else if (scene == "staircase" || scene == "plane") {
    SensorOptions::require_in_range(sensor, parameters.near_m, "--near");
    SensorOptions::require_in_range(sensor, parameters.far_m, "--far");
  }
}

OwnMap FrameScene::targets(const SensorModel& sensor) const {
  SceneParameters all = parameters;
  all.columns = array_columns.value_or(sensor.columns);
  all.rows = array_rows.value_or(sensor.rows);
  all.reflectivity = reflectivity.value_or(sensor.default_reflectivity);
  if (!maps.depth.empty()) {
    OwnMap map = read_own_map(maps, map_scales, all.columns, all.rows, all.reflectivity);
    require_reachable(map.targets, sensor, name(), true);
    return map;
  }
  OwnMap made = cube.file.empty() ? OwnMap{make_scene(parse_scene(scene), all), {}}
                                  : read_own_cube(cube, sensor, all.columns, all.rows, all.reflectivity);
  if (!maps.reflectivity.empty()) {
    made.description += made.description.empty() ? "" : " ";
    made.description += apply_reflectivity_map(made.targets, maps.reflectivity, map_scales);
  }
  require_reachable(made.targets, sensor, cube.file.empty() ? "--scene " + scene : cube.file);
  return made;
}

}  // namespace dtof
