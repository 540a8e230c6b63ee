// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Built-in scenes. Depth is the range along a pixel's ray.
enum class Scene {
  kFlat,       ///< one distance everywhere
  kStaircase,  ///< steps from near (column 0) to far (last column), equally wide and equally high
  kPlane,      ///< slanted: range grows linearly from near (column 0) to far (last column)
  kRoom,       ///< sphere and boxes before the walls of a room, 0.8 to 5 m, reflectivity 0.2 to 1
  kPlanes,     ///< 28 slanted planes side by side, 0.5 to 5 m, reflectivity 0.1 to 0.9
  kClutter,    ///< branches and leaves before a slanted ground, 1 to 4.5 m
  kPoles,      ///< poles and wires of 1 to 3 pixels before a wall, 0.8 to 4 m
  kIsolated,   ///< single pixels at 3 m before a wall at 4 m
  kSky,  ///< no return above a ragged wall at 4 m; boxes at 3 m and poles at 2 and 3 m stand out into it
};

inline constexpr std::array<Scene, 9> kAllScenes = {Scene::kFlat,  Scene::kStaircase, Scene::kPlane,
                                                    Scene::kRoom,  Scene::kPlanes,    Scene::kClutter,
                                                    Scene::kPoles, Scene::kIsolated,  Scene::kSky};

/// Command-line name: flat, staircase, plane, room, planes, clutter, poles, isolated, sky.
std::string_view scene_name(Scene scene);
/// One sentence that describes the scene.
std::string_view scene_summary(Scene scene);
/// Scene by its command-line name. Throws InputError that lists the known names.
Scene parse_scene(std::string_view name);

struct SceneParameters {
  int columns = 200;
  int rows = 160;
  double distance_m = 1.0;    ///< flat, m
  double near_m = 0.8;        ///< staircase and plane, m
  double far_m = 5.0;         ///< staircase and plane, m; may be below near_m
  int steps = 8;              ///< staircase; >= 1
  double reflectivity = 1.0;  ///< of every surface; in the room, of the brightest one
  std::uint64_t seed = 1;     ///< seed of the shapes of planes, clutter and poles
};

/// Throws InputError if a parameter that the scene uses is out of range. Distances must be finite and > 0,
/// reflectivity finite and >= 0.
TargetMap make_scene(Scene scene, const SceneParameters& parameters);

/// Makes targets from a depth image of width x height. `metres` is row by row, row 0 on top; values of 0, NaN
/// and infinity are pixels without target. The whole image is resampled to the array by nearest neighbour.
/// Throws InputError for a wrong number of values or a negative depth.
TargetMap scene_from_depth_image(int width, int height, std::span<const float> metres, int columns, int rows,
                                 double reflectivity = 1.0);

/// Width and height of a transient cube of this shape. Throws InputError for no such shape.
std::array<int, 2> transient_cube_size(std::span<const std::size_t> shape);

/// Makes a scene from a transient cube: `values` of `shape` (rows, columns, bins), which may have a last axis
/// of one element. Each value times `scale.events_per_unit` is the mean number of detected events of a pixel
/// and pulse in its bin. The whole cube is resampled to the array by nearest neighbour.
///
/// A pixel's true distance is that of the centroid of its strongest return: the window of `pulse_fwhm_s` with
/// the most events (TransientCube::strongest_return). A pixel without light has no target. `reflectivity`
/// scales the sunlight alone. Throws InputError for another shape, a value that is negative or not finite, an
/// illegal scale, and a strongest return before the laser's shot.
TargetMap scene_from_transient_cube(std::span<const std::size_t> shape, std::span<const double> values,
                                    const TransientScale& scale, double pulse_fwhm_s, int columns, int rows,
                                    double reflectivity = 1.0);

/// Gives the next values of a cube in C order.
using NextValues = std::function<void(std::span<double>)>;

/// The same of values that are read once from the first to the last, pixel by pixel, so that the cube may be
/// larger than memory.
TargetMap scene_from_transient_cube(std::span<const std::size_t> shape, const NextValues& next,
                                    const TransientScale& scale, double pulse_fwhm_s, int columns, int rows,
                                    double reflectivity = 1.0);

/// Sets every target's reflectivity from a map of width x height (`values` row by row, row 0 on top),
/// resampled to the array by nearest neighbour. Throws InputError for a wrong number of values, or a value
/// that is negative or not finite.
void set_reflectivity(TargetMap& targets, int width, int height, std::span<const float> values);

}  // namespace dtof
