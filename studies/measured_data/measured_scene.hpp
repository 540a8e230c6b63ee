// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/resampling.hpp"

namespace dtof {

/// A recording with known distances of its pixels, from which frames are drawn.
struct MeasuredScene {
  std::string title;
  std::string description;  ///< sentences for a report: contents, and origin of the true distances
  int columns = 0;
  int rows = 0;
  /// True distance in m, index = row * columns + column; 0: unknown, not judged.
  std::vector<double> true_m;
  /// Distance of a second surface, where the pixel sees one; else `true_m`. Empty: the scene has no second
  /// surfaces.
  std::vector<double> other_m;
  /// Makes a frame of the scene.
  std::function<std::unique_ptr<StreamSource>(const Resampling&)> frame;
};

/// Log of an ams TMF8829; the distances that the sensor reported count as true. The published log holds
/// histograms of the sensor's row 0 only. Therefore each frame of the log becomes a column, with the zones of
/// that row as its pixels; neighbours in a column are neighbours in the scene. Throws InputError for an
/// unreadable log.
MeasuredScene tmf8829_scene(const std::filesystem::path& path);

/// Photon times of a scene with two surfaces. Time = tick * `tick_s` + `shift_s`; distance = c/2 time.
struct TwoSurfaces {
  PhotonTimes photons;
  MatMatrix first;   ///< ticks of the nearer surface, estimated from all photons
  MatMatrix second;  ///< ticks of the farther surface
  double tick_s = 8e-12;
  double shift_s = 0.0;
  double from_tick = 0.0;  ///< above 0: earlier photons are left out, and the scene has one surface
};

/// Scene from photon times. A pixel's true distance is that of the surface with more photons within
/// `kSurfaceTicks`. Pixels without such photons or distances are unknown. Throws InputError if sizes
/// disagree.
MeasuredScene two_surfaces_scene(TwoSurfaces recording);

/// About four standard deviations of the recorded pulse, in ticks.
inline constexpr double kSurfaceTicks = 150.0;

}  // namespace dtof
