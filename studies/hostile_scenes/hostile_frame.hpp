// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "hostile_scenes/hostile_scenes.hpp"
#include "hostile_scenes/own_instant.hpp"

namespace dtof {

/// Read-outs to measure, with the look-up tables of the read-outs and of the two references, and their
/// additional knowledge.
struct Estimators {
  std::vector<ReadoutParameters> readouts;
  std::vector<std::string> names;
  std::vector<RangeConverter> tables;
  std::vector<double> returns = {};  ///< for the references: mean events of the surroundings in each bin
  std::uint32_t settle = 0;          ///< number of acquisitions dropped at the frame's start
  /// If set, errors are relative to the target's position at the estimator's own instant.
  const OwnInstants* instants = nullptr;
};

/// Look-up tables of the read-outs and the references.
std::vector<RangeConverter> fit_hostile_tables(const HostileSettings& settings, double klux);

/// Mean events per bin and acquisition that the surroundings alone return to a pixel (frame/empty_frame.hpp).
std::vector<double> mean_returns(const std::vector<ColumnStream>& empty, const SensorModel& sensor);

/// Distance that a target recedes during a frame, m.
double travel_of_a_frame(const SensorModel& sensor);

/// Counts of each estimator for `maps`, by seed.
HostileReadouts measure_hostile(const HostileSettings& settings, const Estimators& estimators,
                                const SensorModel& sensor, double klux, const std::vector<TargetMap>& maps,
                                std::uint64_t first_seed);

}  // namespace dtof
