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

/// Name of the sensor without a condition.
inline constexpr std::string_view kClear = "clear";

struct HostileSettings {
  SensorModel sensor;
  std::vector<ReadoutParameters> readouts;
  std::vector<std::string> conditions;  ///< kClear (required) and names of sensor/condition.hpp
  std::vector<double> klux = {14.0, 50.0};
  std::vector<Scene> scenes = {Scene::kRoom, Scene::kPlanes, Scene::kPoles, Scene::kSky};
  int rows = 64;               ///< judged rows of each scene
  int seeds = 4;               ///< at least 2
  double false_alarms = 0.01;  ///< share of a clear sky's pixels that may pass the threshold
  std::uint64_t seed = 1;
  int threads = 0;
  /// Folder with a file for each measured cell. Cells found there are not measured again. The folder must
  /// belong to this program and these settings.
  std::filesystem::path store;
};

/// Result of a pixel: error up to 3 %, up to 10 %, above 10 %, or no target.
enum class Outcome : std::size_t { kWithin3, kWithin10, kBeyond, kSky };

/// Pixel counts of one seed's frames, over all scenes, by outcome and confidence.
struct HostileCounts {
  std::array<ConfidenceCounts, 4> by_confidence;
  std::uint64_t near_target = 0;  ///< pixels whose result is within 0.3 m of their target
  std::int64_t error_um = 0;      ///< sum of these pixels' errors; above 0: too far

  bool operator==(const HostileCounts&) const = default;
  void add(Outcome outcome, int confidence) {
    ++by_confidence.at(static_cast<std::size_t>(outcome))[confidence];
  }
  /// Pixels with this outcome and at least this confidence.
  [[nodiscard]] std::uint64_t count(Outcome outcome, int least_confidence = 0) const;
  /// Pixels with a target.
  [[nodiscard]] std::uint64_t targets() const;
};

struct HostileCell {
  std::string condition;
  double klux = 0.0;

  auto operator<=>(const HostileCell&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Counts by estimator name and seed.
using HostileReadouts = std::map<std::string, std::vector<HostileCounts>>;

struct HostileScenes {
  std::map<HostileCell, HostileReadouts> cells;
  /// Estimators with the knowledge of a user who knows the sensor and its surroundings:
  ///  - cover glass and fog: TEMPLATE registers of the pool read-outs; the references subtract the returns
  ///    from their scores;
  ///  - skew: S1 off;
  ///  - a laser that is silent at first: SETTLE, with as many acquisitions fewer;
  ///  - motion: all estimators are judged by the target's position at their own instant.
  std::map<HostileCell, HostileReadouts> compensated;
  /// Instants of each estimator, for the conditions in which targets move.
  std::map<HostileCell, OwnInstants> instants;
  /// Confidence thresholds of each estimator, the same for all light levels.
  std::map<std::string, int> thresholds;
};

/// Names and titles of the estimators: the read-outs and two references on full histograms. The references
/// are the matched filter of single pixels and the one pooled along the column. They know the pulse, each
/// pixel's background and the signal of a target at 3 m. Their confidence is eight times their score.
std::vector<std::string> hostile_estimators(const HostileSettings& settings);
std::string hostile_title(const std::string& estimator);
/// Estimators in the tables with additional knowledge: coarse histogram, pool read-outs, references.
std::vector<std::string> compensated_estimators(const HostileSettings& settings);
/// Conditions of the settings for which additional knowledge exists.
std::vector<std::string> compensated_conditions(const HostileSettings& settings);
/// Acquisitions at the frame's start in which the laser is silent.
std::uint32_t silent_acquisitions(const SensorModel& sensor);
/// True if targets move in this condition.
bool moves(const HostileSettings& settings, const std::string& condition);

/// Lowest confidence that at most `share` of the pixels reach, at each light level. `skies` holds the counts
/// of pixels without target, by light level and seed.
int least_confidence(const std::vector<std::vector<HostileCounts>>& skies, double share);

/// Measures every condition at every light level. Each estimator has a look-up table per light level, fitted
/// in clear conditions (frame/flat_calibration.hpp). Its threshold comes from frames of sky alone. Throws
/// InputError for settings out of range.
HostileScenes run_hostile_scenes(const HostileSettings& settings);

/// Share of the pixels with a target whose error exceeds this many per cent, 3 or 10.
Estimate share_above(const std::vector<HostileCounts>& seeds, int percent);
/// Mean error of the pixels near their target, m; 0 without such pixels.
double mean_error(const std::vector<HostileCounts>& seeds);
/// Share of the pixels with a target that pass the threshold with an error of at most 3 %.
Estimate share_detected(const std::vector<HostileCounts>& seeds, int threshold);
/// Share of the pixels without a target that pass the threshold; none without such pixels.
std::optional<Estimate> share_of_false_alarms(const std::vector<HostileCounts>& seeds, int threshold);

}  // namespace dtof
