// SPDX-License-Identifier: Apache-2.0
#include "dtof/scene/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/suggestion.hpp"
#include "dtof/scene/outdoor.hpp"
#include "dtof/scene/room.hpp"

namespace dtof {
namespace {

void require_distance(double metres, std::string_view what) {
  if (!std::isfinite(metres) || metres <= 0.0) {
    throw InputError(
        fmt::format("scene: the {} must be a finite number of metres above 0, not {}", what, metres));
  }
}

void require_reflectivity(double reflectivity) {
  if (!std::isfinite(reflectivity) || reflectivity < 0.0) {
    throw InputError(
        fmt::format("scene: the reflectivity must be a finite number of at least 0, not {}", reflectivity));
  }
}

/// A map whose columns are uniform.
template <typename DepthOfColumn>
TargetMap map_of_columns(const SceneParameters& parameters, DepthOfColumn depth_of_column) {
  TargetMap map(parameters.columns, parameters.rows);
  for (int column = 0; column < parameters.columns; ++column) {
    for (int row = 0; row < parameters.rows; ++row) {
      map.at(column, row) = {.depth_m = depth_of_column(column), .reflectivity = parameters.reflectivity};
    }
  }
  return map;
}

/// `index` of `count` equidistant values from near to far.
double between(const SceneParameters& parameters, int index, int count) {
  const double share = count > 1 ? static_cast<double>(index) / (count - 1) : 0.0;
  return std::lerp(parameters.near_m, parameters.far_m, share);
}

/// The source pixel whose area holds the middle of the array's pixel.
int nearest(int index, int count, int source_count) {
  return static_cast<int>((2 * std::int64_t{index} + 1) * source_count / (2 * std::int64_t{count}));
}

/// The array's pixels that each source pixel stands for, along one axis.
std::vector<std::vector<int>> nearest_to_each(int count, int source_count) {
  std::vector<std::vector<int>> pixels(static_cast<std::size_t>(source_count));
  for (int index = 0; index < count; ++index) {
    pixels[static_cast<std::size_t>(nearest(index, count, source_count))].push_back(index);
  }
  return pixels;
}

/// Sets the light of the array's pixels. All values are checked, also of pixels that the array does not have.
void take_light(std::span<const std::size_t> shape, const NextValues& next, TransientCube& cube) {
  constexpr std::size_t kMostBins = std::size_t{1} << 27U;
  const auto [width, height] = transient_cube_size(shape);
  if (shape[2] > kMostBins) {
    throw InputError(
        fmt::format("shape ({}): a pixel of a transient cube has at most 2^27 bins", fmt::join(shape, ", ")));
  }
  const std::vector<std::vector<int>> columns_of = nearest_to_each(cube.columns(), width);
  const std::vector<std::vector<int>> rows_of = nearest_to_each(cube.rows(), height);
  std::vector<double> values(shape[2]);
  for (std::size_t y = 0; y < rows_of.size(); ++y) {
    for (std::size_t x = 0; x < columns_of.size(); ++x) {
      next(values);
      const auto wrong =
          std::ranges::find_if(values, [](double value) { return !(value >= 0.0) || std::isinf(value); });
      if (wrong != values.end()) {
        throw InputError(fmt::format("column {}, row {}, bin {}: {} is not a finite number of at least 0", x,
                                     y, wrong - values.begin(), *wrong));
      }
      for (const int row : rows_of[y]) {
        for (const int column : columns_of[x]) {
          cube.set(column, row, values);
        }
      }
    }
  }
}

}  // namespace

std::string_view scene_name(Scene scene) {
  switch (scene) {
    case Scene::kFlat:
      return "flat";
    case Scene::kStaircase:
      return "staircase";
    case Scene::kPlane:
      return "plane";
    case Scene::kRoom:
      return "room";
    case Scene::kPlanes:
      return "planes";
    case Scene::kClutter:
      return "clutter";
    case Scene::kPoles:
      return "poles";
    case Scene::kIsolated:
      return "isolated";
    case Scene::kSky:
      return "sky";
  }
  throw InputError("scene: no such scene");
}

std::string_view scene_summary(Scene scene) {
  switch (scene) {
    case Scene::kFlat:
      return "One distance everywhere.";
    case Scene::kStaircase:
      return "Equal steps in depth from the near left to the far right.";
    case Scene::kPlane:
      return "A slanted plane, near on the left and far on the right.";
    case Scene::kRoom:
      return "A sphere and boxes of different reflectivity in a room, 0.8 to 5 m.";
    case Scene::kPlanes:
      return "28 slanted planes side by side, 0.5 to 5 m, reflectivity 0.1 to 0.9.";
    case Scene::kClutter:
      return "Branches and leaves before a slanted ground, 1 to 4.5 m.";
    case Scene::kPoles:
      return "Poles and wires of 1 to 3 pixels before a wall, 0.8 to 4 m.";
    case Scene::kIsolated:
      return "Single pixels at 3 m before a wall at 4 m.";
    case Scene::kSky:
      return "Sky without a return above a ragged wall at 4 m, with boxes and poles before it.";
  }
  throw InputError("scene: no such scene");
}

Scene parse_scene(std::string_view name) {
  std::vector<std::string_view> known;
  for (const Scene scene : kAllScenes) {
    if (scene_name(scene) == name) {
      return scene;
    }
    known.push_back(scene_name(scene));
  }
  throw InputError(unknown_name("scene", name, known));
}

TargetMap make_scene(Scene scene, const SceneParameters& parameters) {
  require_reflectivity(parameters.reflectivity);
  if (scene == Scene::kStaircase || scene == Scene::kPlane) {
    require_distance(parameters.near_m, "near distance");
    require_distance(parameters.far_m, "far distance");
  }
  switch (scene) {
    case Scene::kFlat:
      require_distance(parameters.distance_m, "distance");
      return map_of_columns(parameters, [&](int) { return parameters.distance_m; });
    case Scene::kStaircase:
      if (parameters.steps < 1) {
        throw InputError(fmt::format("scene: a staircase has at least 1 step, not {}", parameters.steps));
      }
      return map_of_columns(parameters, [&](int column) {
        const auto step = std::int64_t{column} * parameters.steps / parameters.columns;
        return between(parameters, static_cast<int>(step), parameters.steps);
      });
    case Scene::kPlane:
      return map_of_columns(parameters,
                            [&](int column) { return between(parameters, column, parameters.columns); });
    case Scene::kRoom:
      return make_room(parameters.columns, parameters.rows, parameters.reflectivity);
    case Scene::kPlanes:
      return make_planes(parameters.columns, parameters.rows, parameters.reflectivity, parameters.seed);
    case Scene::kClutter:
      return make_clutter(parameters.columns, parameters.rows, parameters.reflectivity, parameters.seed);
    case Scene::kPoles:
      return make_poles(parameters.columns, parameters.rows, parameters.reflectivity, parameters.seed);
    case Scene::kIsolated:
      return make_isolated(parameters.columns, parameters.rows, parameters.reflectivity);
    case Scene::kSky:
      return make_sky(parameters.columns, parameters.rows, parameters.reflectivity);
  }
  throw InputError("scene: no such scene");
}

TargetMap scene_from_depth_image(int width, int height, std::span<const float> metres, int columns, int rows,
                                 double reflectivity) {
  require_reflectivity(reflectivity);
  if (width < 1 || height < 1 ||
      metres.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw InputError(fmt::format("scene: a depth image of {} x {} pixels cannot have {} values", width,
                                 height, metres.size()));
  }
  TargetMap map(columns, rows);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const int x = nearest(column, columns, width);
      const int y = nearest(row, rows, height);
      const double depth_m =
          metres[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
      if (depth_m < 0.0) {
        throw InputError(
            fmt::format("scene: depth image, pixel (column {}, row {}): negative depth {} m", x, y, depth_m));
      }
      map.at(column, row) = {.depth_m = std::isfinite(depth_m) ? depth_m : 0.0, .reflectivity = reflectivity};
    }
  }
  return map;
}

std::array<int, 2> transient_cube_size(std::span<const std::size_t> shape) {
  constexpr std::size_t kMostPixels = 65535;
  const std::string text = fmt::format("{}", fmt::join(shape, ", "));
  if (shape.size() == 4 && shape[3] > 1 && shape[3] <= 4) {
    throw InputError(fmt::format(
        "shape ({}): a transient cube has no colours; take one channel, or the mean of all", text));
  }
  if (shape.size() < 3 || shape.size() > 4 || (shape.size() == 4 && shape[3] != 1)) {
    throw InputError(fmt::format("shape ({}): a transient cube has rows, columns and time bins", text));
  }
  if (shape[0] < 1 || shape[0] > kMostPixels || shape[1] < 1 || shape[1] > kMostPixels || shape[2] < 1) {
    throw InputError(
        fmt::format("shape ({}): a transient cube has 1 to {} rows and columns", text, kMostPixels));
  }
  return {static_cast<int>(shape[1]), static_cast<int>(shape[0])};
}

TargetMap scene_from_transient_cube(std::span<const std::size_t> shape, std::span<const double> values,
                                    const TransientScale& scale, double pulse_fwhm_s, int columns, int rows,
                                    double reflectivity) {
  require_reflectivity(reflectivity);
  (void)transient_cube_size(shape);
  if (values.size() / shape[2] != shape[0] * shape[1] || values.size() % shape[2] != 0) {
    throw InputError(fmt::format("shape ({}): a transient cube of this shape cannot have {} values",
                                 fmt::join(shape, ", "), values.size()));
  }
  const NextValues next = [&](std::span<double> some) {
    std::ranges::copy(values.first(some.size()), some.begin());
    values = values.subspan(some.size());
  };
  return scene_from_transient_cube(shape, next, scale, pulse_fwhm_s, columns, rows, reflectivity);
}

TargetMap scene_from_transient_cube(std::span<const std::size_t> shape, const NextValues& next,
                                    const TransientScale& scale, double pulse_fwhm_s, int columns, int rows,
                                    double reflectivity) {
  require_reflectivity(reflectivity);
  const auto [width, height] = transient_cube_size(shape);
  TargetMap map(columns, rows);
  auto cube = std::make_shared<TransientCube>(columns, rows, scale);
  take_light(shape, next, *cube);
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const TransientReturn strongest = cube->strongest_return(column, row, pulse_fwhm_s);
      if (strongest.events > 0.0 && !(strongest.distance_m > 0.0)) {
        throw InputError(
            fmt::format("column {}, row {}: the strongest return is at {:g} m, before the laser's shot; see "
                        "the cube's start",
                        nearest(column, columns, width), nearest(row, rows, height), strongest.distance_m));
      }
      map.at(column, row) = {.depth_m = strongest.distance_m, .reflectivity = reflectivity};
    }
  }
  map.set_cube(std::move(cube));
  return map;
}

void set_reflectivity(TargetMap& targets, int width, int height, std::span<const float> values) {
  if (width < 1 || height < 1 ||
      values.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
    throw InputError(fmt::format("scene: a reflectivity map of {} x {} pixels cannot have {} values", width,
                                 height, values.size()));
  }
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < targets.rows(); ++row) {
      const auto x = static_cast<std::size_t>(nearest(column, targets.columns(), width));
      const auto y = static_cast<std::size_t>(nearest(row, targets.rows(), height));
      const double reflectivity = values[y * static_cast<std::size_t>(width) + x];
      require_reflectivity(reflectivity);
      targets.at(column, row).reflectivity = reflectivity;
    }
  }
}

}  // namespace dtof
