// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "dtof/core/frame_time.hpp"
#include "dtof/design/array_memories.hpp"
#include "dtof/design/coefficients.hpp"
#include "dtof/design/estimate.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Limits of a design; infinite: no limit.
struct DesignLimits {
  double most_mm2 = std::numeric_limits<double>::infinity();
  double most_mw = std::numeric_limits<double>::infinity();
  FrameBudget budget;
};

/// A read-out with its parameters for a sensor, and the cost of its array.
struct DesignCandidate {
  ArrayChoice array;
  CostEstimate cost;
  double slots_taken = 0.0;  ///< share of the TDC's slots that hold a detection, at the brightest light level
  std::uint64_t clocks = 0;  ///< clocks of a frame

  [[nodiscard]] Readout readout() const { return array.parameters.readout; }
  /// Power in mW while acquisitions stream in.
  [[nodiscard]] double mw(double clock_hz) const;
  [[nodiscard]] double frames_per_s(double clock_hz) const { return clock_hz / static_cast<double>(clocks); }
};

/// For each limit, whether a candidate meets it.
struct LimitsKept {
  bool area;
  bool power;
  bool frame;  ///< the frame rate at the requested clock
  bool clock;  ///< the requested clock in the slow corner

  [[nodiscard]] bool all() const { return area && power && frame && clock; }
};
LimitsKept limits_kept(const DesignCandidate& candidate, const DesignLimits& limits);

/// Returns every legal combination of the searched parameters, for read-outs that have RTL. Searched are NB,
/// COUNT_WIDTH, FRACTION_BITS, WINDOW_CENTRED and CELL_SHIFT around default_parameters, and SLOTS.
std::vector<ReadoutParameters> searched_parameters(const SensorModel& sensor);

/// Returns one array for the sensor or, if that is too slow for the clock, the fewest arrays side by side
/// that are fast enough. Pointers are in memories of one port, which are smaller, if SLOTS is at least 2.
/// Arrays as narrow as the synthesised array on which the estimates rest are not split further.
ArrayChoice array_for(const ReadoutParameters& parameters, const SensorModel& sensor, double clock_hz);

/// Copy of the sensor with this number of slots.
SensorModel with_slots(SensorModel sensor, int slots);

/// Options of `dtof product` and `dtof frame` that select these parameters, e.g. "--readout sifh --nb 5".
std::string command_options(const ReadoutParameters& parameters, const SensorModel& sensor);
/// Options of `dtof product` that select this array.
std::string product_options(const ArrayChoice& array, const SensorModel& sensor);

}  // namespace dtof
