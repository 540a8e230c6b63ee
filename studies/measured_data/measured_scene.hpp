// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/recording/photon_times_mat.hpp"
#include "dtof/recording/recording.hpp"
#include "dtof/recording/resampling.hpp"

namespace dtof {

/// Where true distances come from.
enum class TruthOrigin : std::uint8_t {
  kUnknown,
  kStrongestReturn,  ///< of each pixel
  kPlane,            ///< known in each capture
  kSensor,           ///< reported by the sensor itself
  kSurface,          ///< that more of the pixel's photons come from
  kMap               ///< a file that the user names
};

/// What a report says about the true distances.
struct MeasuredTruth {
  TruthOrigin origin = TruthOrigin::kUnknown;
  double window_s = 0.0;           ///< of the strongest return
  std::size_t without_return = 0;  ///< pixels left out
  std::string map = {};            ///< name of its file
  double range_m = 0.0;
  std::size_t beyond_range = 0;  ///< pixels left out

  bool operator==(const MeasuredTruth&) const = default;
};

/// A recording with known distances of its pixels, from which frames are drawn.
struct MeasuredScene {
  std::string title;
  std::string contents;       ///< of a recording; empty: photon times with surfaces
  bool is_tmf8829 = false;    ///< a log in which frames become columns
  double mean_photons = 0.0;  ///< of a pixel with surfaces
  double from_tick = 0.0;     ///< above 0: earlier photons are left out
  MeasuredTruth truth;
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

/// Window of strongest_return if none is given, s.
inline constexpr double kReturnWindow = 2e-9;

/// How a recording becomes a scene.
struct RecordedSceneOptions {
  RecordingOptions recording;
  double shift_s = 0.0;  ///< s, added to every time
  /// s, the window of strongest_return (strongest_return.hpp); none: kReturnWindow, and the recording may
  /// have true distances.
  std::optional<double> return_window_s = std::nullopt;
  bool truth_is_given = false;  ///< true: the caller knows the true distances, and none are looked for
};

/// Scene from any recording but a TDC stream: histograms, photon times, time tags, logs of sensors. The true
/// distances are those of the recording. If the recording has none, a pixel's true distance is that of the
/// strongest return among all of its photons, at c/2 (time + shift); a pixel without a return is unknown.
/// The published log of a TMF8829 holds histograms of the sensor's row 0 only. Therefore each frame of such a
/// log becomes a column, with the zones of that row as its pixels. `file` has the contents of the recording
/// (read_recording). Throws InputError for an unreadable recording, for a TDC stream, and if no pixel has a
/// return.
MeasuredScene recorded_scene(const RecordedSceneOptions& options, RecordingFile file);

/// Leaves out pixels whose light returns after `integration_time` (s), and counts them in `truth`. Throws
/// InputError "<name>: <reason>" if no pixel with a known distance is left.
void leave_out_beyond_range(MeasuredScene& scene, double integration_time, const std::string& name);

/// True distances as CSV: column, row, true_m, other_m; empty if unknown.
std::string truth_csv(const MeasuredScene& scene);

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
