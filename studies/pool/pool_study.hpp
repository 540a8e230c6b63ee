// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dtof/frame/flat_calibration.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/readout/pool_pointer.hpp"
#include "scenes/scene_study.hpp"

namespace dtof {

/// Parses a design of poolPointer with changed numbers, NAME=NUMBER,...: "LEAK_SHIFT=2,SMOOTH_DARK=768". An
/// empty `text` changes nothing. Throws InputError for an unknown name or an illegal value.
PoolNumbers parse_pool_design(const std::string& text);
/// Names that parse_pool_design accepts.
std::vector<std::string> pool_design_names();
/// Number of a design by its name; next, the design with another number, not validated.
int pool_design_number(const PoolNumbers& design, const std::string& name);
PoolNumbers with_pool_design_number(PoolNumbers design, const std::string& name, int number);

/// Events of all columns of a map, by engine from left to right.
struct PoolFrame {
  std::uint32_t acquisitions = 0;
  std::vector<std::vector<PoolColumn>> engines;
};
PoolFrame draw_pool_frame(const SensorModel& sensor, const TargetMap& targets, double klux,
                          std::uint64_t seed, std::uint32_t frame, int engine_columns, int threads);

/// Reads out whole maps with designs of poolPointer, each with and without S1, and with the matched filters
/// of SceneStudy; single-pixel matched filter also with S1. All see the same photons.
class PoolStudy {
 public:
  /// All designs must have the same engine_columns. `references`: include the matched filters.
  PoolStudy(SensorModel sensor, double klux, std::span<const std::string> designs, bool references,
            std::uint64_t seed, int threads, TableRule table);

  /// Titles: the matched filters, then each design without and with S1.
  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }
  /// One measurement per estimator, of the scene's whole map. Throws InputError if the scene asks for fewer
  /// columns.
  [[nodiscard]] std::vector<SceneMeasurement> measure(const StudyScene& scene) const;

 private:
  using Positions = std::vector<std::vector<Measurement>>;  // estimator, row * columns + column
  [[nodiscard]] Positions read(const TargetMap& targets, std::uint32_t frame, int engine_columns) const;

  SensorModel sensor_;
  double klux_;
  std::vector<PoolNumbers> designs_;
  bool references_;
  std::vector<std::string> titles_;
  std::uint64_t seed_;
  int threads_;
  DepthScale scale_;
  std::vector<RangeConverter> converters_;  // for each estimator; empty without look-up tables
};

}  // namespace dtof
