// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/design/array_memories.hpp"
#include "dtof/design/coefficients.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Most columns of a poolPointer engine whose line meets the clock of the reference: the widest synthesised
/// one.
inline constexpr int kWidestEngine = 100;

/// Area, clock and memory of all arrays together, by models fitted to synthesised configurations.
struct CostEstimate {
  double mm2 = 0.0;
  double fmax_mhz = 0.0;  ///< in the slow corner
  double bits_per_pixel = 0.0;
};

CostEstimate estimate_cost(const ArrayChoice& array,
                           const EstimateCoefficients& coefficients = EstimateCoefficients::built_in());

/// Mean share of the TDC's slots that hold a detection, over a scene's pixels.
double slot_rate(const SensorModel& sensor, const TargetMap& targets, double klux);
/// slot_rate of the scene on which the power of the synthesised configurations was measured.
double reference_slot_rate(double klux);

/// Power in mW while acquisitions stream in at `clock_mhz`; `slots_taken`: share of slots that hold a
/// detection.
double estimate_mw(const ArrayChoice& array, double slots_taken, double clock_mhz,
                   const EstimateCoefficients& coefficients = EstimateCoefficients::built_in());

}  // namespace dtof
