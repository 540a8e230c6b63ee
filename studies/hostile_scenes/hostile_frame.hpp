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

/// What is read, with a look-up table of each and of the two references behind them, and what they are told.
struct Estimators {
  std::vector<ReadoutParameters> readouts;
  std::vector<std::string> names;
  std::vector<RangeConverter> tables;
  std::vector<double> returns = {};       ///< mean events of each bin from surroundings, for the references
  std::uint32_t settle = 0;               ///< acquisitions at the frame's start that are dropped
  const OwnInstants* instants = nullptr;  ///< judged where the target is at the own instant
};

/// Look-up tables of the read-outs and the references.
std::vector<RangeConverter> fit_hostile_tables(const HostileSettings& settings, double klux);

/// Mean events of each bin that surroundings alone send back to a pixel in an acquisition
/// (frame/empty_frame.hpp).
std::vector<double> mean_returns(const std::vector<ColumnStream>& empty, const SensorModel& sensor);

/// How far a target goes away in a frame, in m.
double travel_of_a_frame(const SensorModel& sensor);

/// Each estimator's counts of `maps`, by seed.
HostileReadouts measure_hostile(const HostileSettings& settings, const Estimators& estimators,
                                const SensorModel& sensor, double klux, const std::vector<TargetMap>& maps,
                                std::uint64_t first_seed);

}  // namespace dtof
