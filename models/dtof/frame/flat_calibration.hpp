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

/// How codes are converted to metres.
enum class TableRule {
  kNone,  ///< by Eq. 3.11
  kFlat,  ///< by a look-up table for each read-out, fitted by FlatCalibration
};

/// Command-line name: none, flat.
std::string_view table_rule_name(TableRule rule);
/// Rule by its command-line name. Throws InputError for an unknown name.
TableRule parse_table_rule(std::string_view name);

/// Calibration behind `--table flat`, the same for every command. Flat targets of the sensor's default
/// reflectivity stand at 45 distances: 0.05 m apart up to 1 m and 0.2 m beyond, for T_int = 45 ns, and in
/// proportion for another T_int. A distance is left out if the middle of its pulse's falling edge lies beyond
/// T_int, or the pulse's centre outside the time gate. The photons belong to a frame of their own (kFrame),
/// so no scene shares them.
class FlatCalibration {
 public:
  static constexpr int kPixels = 160;         ///< default number of pixels at each distance
  static constexpr std::uint32_t kFrame = 1;  ///< number of the frame that calibration draws

  /// Throws InputError if fewer than two distances remain, or if `pixels` is below 1.
  explicit FlatCalibration(const SensorModel& sensor, int pixels = kPixels);

  [[nodiscard]] const std::vector<double>& distances_m() const { return distances_m_; }
  /// One target per distance. Each covers as many columns as binning and coincidence need to separate the
  /// distances; column() gives the middle one, which is read.
  [[nodiscard]] const TargetMap& targets() const { return targets_; }
  [[nodiscard]] int column(std::size_t distance) const;
  /// targets() twice, side by side, for read-outs whose columns depend on their left neighbour. Each distance
  /// is then read in the right column of a pair; the left one is a column of the first copy.
  [[nodiscard]] TargetMap paired_targets() const;

  /// Fits a table to measurements of the targets, index = row * distances_m().size() + distance.
  [[nodiscard]] RangeConverter fit(std::span<const Measurement> measurements, double code_step,
                                   std::uint64_t seed) const;
  /// Function that draws the photons of targets.
  using Photons = std::function<std::unique_ptr<StreamSource>(const TargetMap& targets)>;

  /// Fits the table of each read-out's model. Photons come from targets(), or from paired_targets() for
  /// read-outs whose columns depend on each other.
  [[nodiscard]] std::vector<RangeConverter> fit(const Photons& photons,
                                                std::span<const ReadoutParameters> readouts,
                                                std::uint64_t seed, int threads) const;

  /// Text for reports: "flat targets of reflectivity 1 at 45 distances from 0.1 to 6.2 m, 160 pixels each".
  [[nodiscard]] std::string description() const;

 private:
  [[nodiscard]] std::size_t pixels() const { return static_cast<std::size_t>(targets_.rows()); }

  double reflectivity_;
  int pitch_;  ///< columns per distance
  std::vector<double> distances_m_;
  TargetMap targets_;
};

/// Sentences for a summary: how codes became distances and figures.
std::string table_sentence(TableRule rule, const SensorModel& sensor, std::uint64_t seed);

/// Frame number of the n-th frame of a scene; skips FlatCalibration::kFrame.
constexpr std::uint32_t scene_frame(std::uint32_t n) { return n < FlatCalibration::kFrame ? n : n + 1; }

}  // namespace dtof
