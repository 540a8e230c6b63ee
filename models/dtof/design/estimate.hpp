// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/design/array_memories.hpp"
#include "dtof/design/coefficients.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Area, clock and memory of an array, of all of them if there are several, by models fitted to synthesised
/// configurations.
struct CostEstimate {
  double mm2 = 0.0;
  double fmax_mhz = 0.0;  ///< in the slow corner
  double bits_per_pixel = 0.0;
};

CostEstimate estimate_cost(const ArrayChoice& array,
                           const EstimateCoefficients& coefficients = EstimateCoefficients::built_in());

/// Share of the TDC's slots that hold a detection, in the mean over a scene's pixels.
double slot_rate(const SensorModel& sensor, const TargetMap& targets, double klux);
/// That of the scene on which the power of the synthesised points was counted.
double reference_slot_rate(double klux);

/// mW while acquisitions stream in at a clock, with so many of the slots taken.
double estimate_mw(const ArrayChoice& array, double slots_taken, double clock_mhz,
                   const EstimateCoefficients& coefficients = EstimateCoefficients::built_in());

}  // namespace dtof
