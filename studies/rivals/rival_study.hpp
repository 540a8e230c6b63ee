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
#include "dtof/rival/rival.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// Reads out scenes with rivals (models/dtof/rival/rival.hpp). The photons of a scene equal those of
/// SceneStudy and PoolStudy with the same sensor, light and seed; a rival that needs several frames gets
/// others before them, without signal events where the rival wants the laser off. Each rival has its own
/// look-up table by FlatCalibration, unless the rule is TableRule::kNone.
///
/// With `pooled` each rival has a second row, "..., pooled", in which the host combines pixels along the
/// column. A rival with evidence gets the chain of the pooled matched filter
/// (readout/pooled_matched_filter.hpp); others get the median of five rows. Both use the look-up table of the
/// rival's single pixels.
class RivalStudy {
 public:
  RivalStudy(SensorModel sensor, double klux, std::span<const RivalEntry> rivals, bool pooled,
             std::uint64_t seed, int threads, TableRule table = TableRule::kFlat);

  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }
  /// Rival of an estimator.
  [[nodiscard]] const Rival& rival(std::size_t estimator) const {
    return *rivals_[pooled_ ? estimator / 2 : estimator];
  }
  /// One measurement per estimator.
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
  std::vector<RangeConverter> converters_;  // for each rival; empty without look-up tables
};

/// Operations that pooling adds to Rival::host_operations().
int pooling_operations(const Rival& rival);

/// For each value, the median of it and its `reach` neighbours on either side (fewer at the ends); the upper
/// of two middle values.
std::vector<double> running_median(std::span<const double> values, std::size_t reach);

}  // namespace dtof
