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

/// A recording with a known distance for its pixels, from which frames are drawn.
struct MeasuredScene {
  std::string title;
  std::string description;  ///< sentences for a report: what it is, where the truth is from
  int columns = 0;
  int rows = 0;
  /// m, index = row * columns + column; 0: unknown, not judged.
  std::vector<double> true_m;
  /// Where a pixel sees a second surface: its distance, else `true_m`. Empty: no scene of two surfaces.
  std::vector<double> other_m;
  /// A frame of it.
  std::function<std::unique_ptr<StreamSource>(const Resampling&)> frame;
};

/// Log of an ams TMF8829 with the sensor's own distances as truth. The published log holds the histograms of
/// the sensor's row 0 only, so a frame of the log becomes a column, and the zones of that row its pixels:
/// neighbours in the column are neighbours in the scene. Throws InputError for an unreadable log.
MeasuredScene tmf8829_scene(const std::filesystem::path& path);

/// Photon times of a scene of two surfaces. Times are tick * `tick_s` + `shift_s`; distances are c/2 of them.
struct TwoSurfaces {
  PhotonTimes photons;
  MatMatrix first;   ///< ticks of the nearer surface, as estimated from all photons
  MatMatrix second;  ///< of the farther one
  double tick_s = 8e-12;
  double shift_s = 0.0;
  double from_tick = 0.0;  ///< above 0: earlier photons are left out, and there is no other surface
};

/// The truth is the surface that more of the pixel's photons come from, those within `kSurfaceTicks` of it.
/// Pixels without such photons or distance are unknown. Throws InputError if sizes disagree.
MeasuredScene two_surfaces_scene(TwoSurfaces recording);

/// About four standard deviations of the recorded pulse.
inline constexpr double kSurfaceTicks = 150.0;

}  // namespace dtof
