// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/metrics/confidence_counts.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"
#include "hostile_scenes/own_instant.hpp"

namespace dtof {

/// No condition: the sensor as it is.
inline constexpr std::string_view kClear = "clear";

struct HostileSettings {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  std::vector<std::string> conditions;  ///< kClear, which must be one, and names of sensor/condition.hpp
  std::vector<double> klux = {14.0, 50.0};
  std::vector<Scene> scenes = {Scene::kRoom, Scene::kPlanes, Scene::kPoles, Scene::kSky};
  int rows = 64;               ///< judged of each scene
  int seeds = 4;               ///< at least 2
  double false_alarms = 0.01;  ///< share of the pixels of a clear sky that the threshold lets pass
  std::uint64_t seed = 1;
  int threads = 0;
  /// Folder of the cells that are done, one file each: what lies there is not measured again. It must belong
  /// to this program and these settings.
  std::filesystem::path store;
};

/// What became of a pixel: error up to 3 %, up to 10 %, above, or no target to be right about.
enum class Outcome : std::size_t { kWithin3, kWithin10, kBeyond, kSky };

/// Pixels of one seed's frames, all scenes together, by outcome and confidence.
struct HostileCounts {
  std::array<ConfidenceCounts, 4> by_confidence;
  std::uint64_t near_target = 0;  ///< with a result at most 0.3 m from their target
  std::int64_t error_um = 0;      ///< sum of these pixels' errors, above 0: too far

  bool operator==(const HostileCounts&) const = default;
  void add(Outcome outcome, int confidence) {
    ++by_confidence.at(static_cast<std::size_t>(outcome))[confidence];
  }
  /// Pixels of at least this confidence.
  [[nodiscard]] std::uint64_t count(Outcome outcome, int least_confidence = 0) const;
  /// With a target.
  [[nodiscard]] std::uint64_t targets() const;
};

struct HostileCell {
  std::string condition;
  double klux = 0.0;

  auto operator<=>(const HostileCell&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Counts of each estimator, by its name, and seed.
using HostileReadouts = std::map<std::string, std::vector<HostileCounts>>;

struct HostileScenes {
  std::map<HostileCell, HostileReadouts> cells;
  /// Estimators that have what a user sets who knows the sensor and what is around it. Cover glass and fog:
  /// TEMPLATE registers of the pool read-outs, and what the references subtract from their scores. Skew: no
  /// S1. A laser that is silent at first: SETTLE, and as many acquisitions less. Motion: all estimators,
  /// judged by where the target is at their own instant.
  std::map<HostileCell, HostileReadouts> told;
  /// Each estimator's, of the conditions in which targets move.
  std::map<HostileCell, OwnInstants> instants;
  std::map<std::string, int> thresholds;  ///< of confidence, of each estimator: one for all lights
};

/// Names and titles of the estimators: the read-outs, and two references on full histograms that know the
/// pulse, the background of each pixel and the signal of a target at 3 m: the matched filter of the single
/// pixel and the one pooled along the column. Their confidence is eight times their score.
std::vector<std::string> hostile_estimators(const HostileSettings& settings);
std::string hostile_title(const std::string& estimator);
/// Those of the tables of what is told: the coarse histogram, pool read-outs, references.
std::vector<std::string> told_estimators(const HostileSettings& settings);
/// Conditions of the settings of which something can be told.
std::vector<std::string> told_conditions(const HostileSettings& settings);
/// Acquisitions at the frame's start in which the laser is silent.
std::uint32_t silent_acquisitions(const SensorModel& sensor);
/// Targets move under the condition.
bool moves(const HostileSettings& settings, const std::string& condition);

/// The lowest confidence that at most `share` of the pixels of each light's seeds have or exceed; the pixels
/// are those without a target.
int least_confidence(const std::vector<std::vector<HostileCounts>>& skies, double share);

/// Measures every condition at every light. Each estimator has a look-up table for each light, of the sensor
/// in clear conditions (frame/flat_calibration.hpp), and its threshold from frames of sky alone. Throws
/// InputError for settings out of range.
HostileScenes run_hostile_scenes(const HostileSettings& settings);

/// Share of the pixels with a target that are further off than this many per cent, 3 or 10.
Estimate share_above(const std::vector<HostileCounts>& seeds, int percent);
/// Mean error of the pixels near their target, in m; 0 if there are none.
double mean_error(const std::vector<HostileCounts>& seeds);
/// Share of the pixels with a target that pass the threshold and are within 3 %.
Estimate share_detected(const std::vector<HostileCounts>& seeds, int threshold);
/// Share of the pixels without a target that pass it; none without such pixels.
std::optional<Estimate> share_of_false_alarms(const std::vector<HostileCounts>& seeds, int threshold);

}  // namespace dtof
