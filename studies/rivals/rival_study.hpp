// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dtof/frame/flat_calibration.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "rivals/models/rival.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// Reads scenes out with rivals (rival/rival.hpp). The photons of a scene are those that SceneStudy and
/// PoolStudy draw of it with the same sensor, light and seed; a rival that needs several frames has others
/// before them. Each rival has a look-up table of its own by FlatCalibration, unless TableRule::kNone.
///
/// With `pooled` each rival has a second row, "..., pooled": the host helps its pixels along the column, by
/// the chain of the pooled matched filter (readout/pooled_matched_filter.hpp) on the rival's evidence, or by
/// the median of five rows where the rival has none. Its table is the one of the pixels alone for the chain,
/// which keeps each pixel's own place, and for the median.
class RivalStudy {
 public:
  RivalStudy(SensorModel sensor, double klux, std::span<const RivalEntry> rivals, bool pooled,
             std::uint64_t seed, int threads, TableRule table = TableRule::kFlat);

  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }
  /// The rival of an estimator.
  [[nodiscard]] const Rival& rival(std::size_t estimator) const {
    return *rivals_[pooled_ ? estimator / 2 : estimator];
  }
  /// One measurement an estimator.
  [[nodiscard]] std::vector<SceneMeasurement> measure(const StudyScene& scene) const;

 private:
  using Positions = std::vector<std::vector<Measurement>>;  // estimator, row * columns + column
  [[nodiscard]] Positions read(const StudyScene& scene, std::uint32_t frame, bool pooled) const;

  SensorModel sensor_;
  double klux_;
  std::vector<std::unique_ptr<Rival>> rivals_;
  bool pooled_;
  std::vector<std::string> titles_;
  std::uint64_t seed_;
  int threads_;
  DepthScale scale_;
  std::vector<RangeConverter> converters_;  // of each rival; empty without look-up tables
};

/// What pooling adds to Rival::host_operations().
int pooling_operations(const Rival& rival);

/// The middle of each value and its `reach` neighbours on either side, fewer at the ends; the upper one of
/// two.
std::vector<double> running_median(std::span<const double> values, std::size_t reach);

}  // namespace dtof
