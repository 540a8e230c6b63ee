// SPDX-License-Identifier: Apache-2.0
#include "common/scene_list.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "command_line/option_checks.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "dtof/io/depth_image.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {
namespace {

constexpr std::array kFlatDistances = {0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0};
constexpr int kFlatColumns = 10;

/// Surfaces have no reflectivity in a depth map: each block of 20 x 20 pixels gets its own.
void vary_reflectivity(TargetMap& targets, double reflectivity, std::uint64_t seed) {
  constexpr int kBlock = 20;
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      const auto block = static_cast<std::uint32_t>(column / kBlock + (row / kBlock << 8));
      CounterRandom random(seed, static_cast<std::uint32_t>(RandomPurpose::kScene), 0, block);
      targets.at(column, row).reflectivity = reflectivity * std::lerp(0.1, 0.9, random.uniform());
    }
  }
}

void put_nearest_at(double nearest_m, const std::string& name, DepthImage& image) {
  float nearest = std::numeric_limits<float>::infinity();
  for (const float metres : image.metres) {
    nearest = metres > 0.0F ? std::min(nearest, metres) : nearest;
  }
  if (!std::isfinite(nearest)) {
    throw InputError(fmt::format("{}: no known depth", name));
  }
  for (float& metres : image.metres) {
    metres *= static_cast<float>(nearest_m) / nearest;
  }
}

/// The map scaled to its nearest point's distance.
void add_depth_map(SceneList& list, const std::string& name, DepthImage image, double nearest_m,
                   const SensorModel& sensor, const SceneChoice& options) {
  put_nearest_at(nearest_m, name, image);
  TargetMap targets =
      scene_from_depth_image(image.width, image.height, image.metres, sensor.columns, sensor.rows);
  vary_reflectivity(targets, sensor.default_reflectivity, options.seed);
  const std::string note = resampling_sentence(fmt::format("nearest point put at {:g} m", nearest_m),
                                               image.width, image.height, targets);
  list.add_map(name, note, std::move(targets), std::min(options.columns, sensor.columns));
}

/// A pixel without a disparity takes the farther of its row's nearest known neighbours: what one of the two
/// cameras did not see is mostly background.
void fill_unknown(DepthImage& image) {
  for (int row = 0; row < image.height; ++row) {
    const auto begin = image.metres.begin() + static_cast<std::ptrdiff_t>(row) * image.width;
    std::vector<float> left(begin, begin + image.width);
    std::vector<float> right = left;
    for (std::size_t i = 1; i < left.size(); ++i) {
      left[i] = left[i] > 0.0F ? left[i] : left[i - 1];
    }
    for (std::size_t i = right.size() - 1; i-- > 0;) {
      right[i] = right[i] > 0.0F ? right[i] : right[i + 1];
    }
    for (std::size_t i = 0; i < left.size(); ++i) {
      begin[static_cast<std::ptrdiff_t>(i)] = std::max(left[i], right[i]);
    }
  }
}

void add_photographed(SceneList& list, const std::string& text, const SensorModel& sensor,
                      const SceneChoice& options) {
  const NamedMap named = parse_named_map(text);
  if (named.files.reflectivity.empty()) {
    throw InputError(fmt::format("--photographed '{}': expected NAME=DISPARITY,PHOTOGRAPH", text));
  }
  if (std::ranges::find(list.scenes, named.name, &StudyScene::name) != list.scenes.end()) {
    throw InputError(fmt::format("--photographed '{}': another map has this name", text));
  }
  DepthImage image = read_disparity_png(named.files.depth, 1.0);
  put_nearest_at(options.nearest_m, named.files.depth, image);
  const auto targets_of = [&](const DepthImage& map) {
    return scene_from_depth_image(map.width, map.height, map.metres, sensor.columns, sensor.rows);
  };
  const TargetMap known = targets_of(image);
  fill_unknown(image);
  TargetMap targets = targets_of(image);
  ReflectivityImage photograph = read_photograph(named.files.reflectivity);
  for (float& value : photograph.values) {
    value = static_cast<float>(std::max(kDarkestPhotographed, double{value}) * sensor.default_reflectivity);
  }
  set_reflectivity(targets, photograph.width, photograph.height, photograph.values);
  const std::string note = resampling_sentence(
      fmt::format("nearest point put at {:g} m, reflectivity of the photograph", options.nearest_m),
      image.width, image.height, known);
  list.add_map(named.name, note, std::move(targets), std::min(options.columns, sensor.columns));
  for (int row = 0; row < sensor.rows; ++row) {
    for (int column = 0; column < sensor.columns; ++column) {
      list.scenes.back().guessed.push_back(!known.at(column, row).returns_signal());
    }
  }
}

/// Rows become columns.
DepthImage turned(const DepthImage& image) {
  DepthImage turned{image.height, image.width, {}};
  for (int row = 0; row < turned.height; ++row) {
    for (int column = 0; column < turned.width; ++column) {
      turned.metres.push_back(image.at(row, column));
    }
  }
  return turned;
}

DepthImage read_surface(const SceneChoice& options) {
  const MatMatrix matrix = read_mat_matrix(options.surface_file, options.surface_variable);
  DepthImage image{matrix.columns, matrix.rows, {}};
  for (const double value : matrix.values) {
    image.metres.push_back(static_cast<float>(value));
  }
  return image;
}

/// Scenes that poolPointer's parameters were not chosen on.
void add_held_out(const SceneChoice& options, const SensorModel& sensor, SceneList& list) {
  constexpr std::uint64_t kOtherShapes = 1000;
  SceneParameters parameters;
  parameters.columns = sensor.columns;
  parameters.rows = sensor.rows;
  parameters.reflectivity = sensor.default_reflectivity;
  parameters.seed = options.seed + kOtherShapes;
  const int columns = std::min(options.columns, sensor.columns);
  for (const Scene scene : {Scene::kPlanes, Scene::kClutter, Scene::kPoles, Scene::kStaircase}) {
    list.scenes.push_back(
        {fmt::format("held {}", scene_name(scene)), make_scene(scene, parameters), columns});
  }
  if (!options.disparity_file.empty()) {
    constexpr double kNearer = 0.6;
    add_depth_map(list, "held disparity map", turned(read_disparity_png(options.disparity_file, 1.0)),
                  kNearer * options.nearest_m, sensor, options);
  }
  if (!options.surface_file.empty()) {
    add_depth_map(list, "held surface", read_surface(options), options.nearest_m, sensor, options);
  }
}

/// The names of flat scenes say their distances.
void scale_distances(StudyScene& scene, double scale) {
  if (scale == 1.0) {
    return;
  }
  for (int column = 0; column < scene.targets.columns(); ++column) {
    for (int row = 0; row < scene.targets.rows(); ++row) {
      scene.targets.at(column, row).depth_m *= scale;
    }
  }
  if (is_flat(scene.name)) {
    scene.name = fmt::format("flat {:g} m", scene.targets.at(0, 0).depth_m);
  }
}

}  // namespace

SceneList make_scenes(const SceneChoice& options, const SensorModel& sensor) {
  SceneList list;
  std::vector<StudyScene>& scenes = list.scenes;
  for (const std::string& name : options.scenes) {
    const Scene scene = parse_scene(name);
    SceneParameters parameters;
    parameters.columns = sensor.columns;
    parameters.rows = sensor.rows;
    parameters.reflectivity = sensor.default_reflectivity;
    parameters.seed = options.seed;
    if (scene == Scene::kFlat) {
      parameters.columns = kFlatColumns;
      for (const double distance : kFlatDistances) {
        parameters.distance_m = distance;
        scenes.push_back({fmt::format("flat {:g} m", distance), make_scene(scene, parameters), kFlatColumns});
      }
    } else {
      scenes.push_back({name, make_scene(scene, parameters), std::min(options.columns, sensor.columns)});
    }
  }
  if (!options.disparity_file.empty()) {
    add_depth_map(list, "disparity map", read_disparity_png(options.disparity_file, 1.0), options.nearest_m,
                  sensor, options);
  }
  for (const std::string& text : options.photographed) {
    add_photographed(list, text, sensor, options);
  }
  for (const std::string& text : options.maps) {
    const NamedMap named = parse_named_map(text);
    if (std::ranges::find(scenes, named.name, &StudyScene::name) != scenes.end()) {
      throw InputError(fmt::format("--map '{}': another map has this name", text));
    }
    OwnMap map = read_own_map(named.files, options.map_scales, sensor.columns, sensor.rows,
                              sensor.default_reflectivity);
    list.add_map(named.name, map.description, std::move(map.targets),
                 std::min(options.columns, sensor.columns));
  }
  if (options.held_out) {
    add_held_out(options, sensor, list);
  }
  for (StudyScene& scene : list.scenes) {
    scale_distances(scene, options.distance_scale);
  }
  return list;
}

void add_scene_options(CLI::App& command, SceneChoice& choice) {
  command
      .add_option("--scene", choice.scenes,
                  "scenes from `dtof list`, one or more (with --map the default is none)")
      ->capture_default_str();
  command.add_option("--map", choice.maps,
                     "also your own scene: NAME=DEPTH or NAME=DEPTH,REFLECTIVITY, files as PNG of 8 or 16\n"
                     "bits, PFM or NPY, resampled to the sensor's pixels by nearest neighbour; one or more");
  choice.map_scales.add_to(command);
  command.add_option("--disparity", choice.disparity_file,
                     "also a disparity map (8-bit PNG, 0 = unknown), its reflectivity varied in blocks");
  command.add_option("--photographed", choice.photographed,
                     "also a disparity map with its photograph, which gives the reflectivity:\n"
                     "NAME=DISPARITY,PHOTOGRAPH (PNG of 8 bits; 0 = unknown); one or more");
  command.add_option("--nearest", choice.nearest_m, "distance of the disparity maps' nearest point, m")
      ->check(above_zero())
      ->capture_default_str();
  command.add_option(
      "--surface", choice.surface_file,
      "with --held-out: also a measured surface (matrix of a MATLAB file, any unit, scaled like\n"
      "the disparity map)");
  command.add_option("--variable", choice.surface_variable, "name of the matrix")->capture_default_str();
  command.add_flag(
      "--held-out", choice.held_out,
      "also scenes that no parameter was chosen on: planes, clutter and poles of other shapes, a\n"
      "staircase, the disparity map turned and nearer");
  command
      .add_option("--distance-scale", choice.distance_scale,
                  "all scenes' distances times this number, for a sensor of another range")
      ->check(above_zero())
      ->capture_default_str();
}

void check_scene_options(const CLI::App& command, SceneChoice& choice) {
  if (!choice.maps.empty() && command.count("--scene") == 0) {
    choice.scenes.clear();
  } else if (choice.maps.empty() &&
             (choice.map_scales.metres_per_unit || choice.map_scales.reflectivity_per_unit)) {
    throw InputError("--depth-scale and --reflectivity-scale need --map");
  }
  if (choice.disparity_file.empty() && choice.photographed.empty()) {
    refuse_without_effect(command, "--nearest", "it places the maps of --disparity and --photographed");
  }
  if (choice.surface_file.empty()) {
    refuse_without_effect(command, "--variable", "it is in the file of --surface");
  }
  if (!choice.held_out) {
    refuse_without_effect(command, "--surface", "it is one of the scenes of --held-out");
  }
}

}  // namespace dtof
