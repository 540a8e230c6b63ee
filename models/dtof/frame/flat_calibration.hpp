// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// How codes become metres.
enum class TableRule {
  kNone,  ///< Eq. 3.11 alone
  kFlat,  ///< the host's look-up table of each read-out, fitted by FlatCalibration
};

/// Command-line names: none, flat.
std::string_view table_rule_name(TableRule rule);
/// Throws InputError for another name.
TableRule parse_table_rule(std::string_view name);

/// The calibration run behind `--table flat`, the same for every command: flat targets of the sensor's
/// default reflectivity at 45 distances, 0.05 m apart up to 1 m and 0.2 m beyond, for T_int = 45 ns, and in
/// proportion for another. Left out are those whose pulse has the middle of its falling edge beyond T_int, or
/// its centre outside the time gate. Each has kPixels pixels, or as many as a study asks for. The photons are
/// those of a frame of its own (kFrame), so that no scene shares them.
class FlatCalibration {
 public:
  static constexpr int kPixels = 160;         ///< of each distance, where nothing else is said
  static constexpr std::uint32_t kFrame = 1;  ///< of the seed

  /// Throws InputError if fewer than two distances are left, or for no pixel.
  explicit FlatCalibration(const SensorModel& sensor, int pixels = kPixels);

  [[nodiscard]] const std::vector<double>& distances_m() const { return distances_m_; }
  /// Each distance has as many columns as binning and coincidence need to keep the distances apart; the one
  /// in the middle is read.
  [[nodiscard]] const TargetMap& targets() const { return targets_; }
  [[nodiscard]] int column(std::size_t distance) const;
  /// targets(), and behind them the same once more, for read-outs whose columns hear each other: what is read
  /// of a distance is the right column of a pair, whose left one is among the others.
  [[nodiscard]] TargetMap paired_targets() const;

  /// The table of measurements of the targets, index = row * distances_m().size() + distance.
  [[nodiscard]] RangeConverter fit(std::span<const Measurement> measurements, double code_step,
                                   std::uint64_t seed) const;
  /// Draws the photons of targets.
  using Photons = std::function<std::unique_ptr<StreamSource>(const TargetMap& targets)>;

  /// The table of each read-out's model, from photons of targets(), or of paired_targets() where its columns
  /// hear each other.
  [[nodiscard]] std::vector<RangeConverter> fit(const Photons& photons,
                                                std::span<const ReadoutParameters> readouts,
                                                std::uint64_t seed, int threads) const;

  /// For reports: "flat targets of reflectivity 1 at 45 distances from 0.1 to 6.2 m, 160 pixels each".
  [[nodiscard]] std::string description() const;

 private:
  [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(targets_.rows()); }

  double reflectivity_;
  int pitch_;  ///< columns of a distance
  std::vector<double> distances_m_;
  TargetMap targets_;
};

/// Sentences for a summary: how distances and figures came from codes.
std::string table_sentence(TableRule rule, const SensorModel& sensor, std::uint64_t seed);

/// Number of the n-th frame of a scene: FlatCalibration::kFrame is left out.
constexpr std::uint32_t scene_frame(std::uint32_t n) { return n < FlatCalibration::kFrame ? n : n + 1; }

}  // namespace dtof
