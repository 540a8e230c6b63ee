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

/// What a read-out has to keep; infinite: no limit.
struct DesignLimits {
  double most_mm2 = std::numeric_limits<double>::infinity();
  double most_mw = std::numeric_limits<double>::infinity();
  FrameBudget budget;
};

/// A read-out with parameters for a sensor, and what its array costs.
struct DesignCandidate {
  ArrayChoice array;
  CostEstimate cost;
  double slots_taken = 0.0;  ///< share of the TDC's slots, in the brightest light
  std::uint64_t clocks = 0;  ///< of a frame

  [[nodiscard]] Readout readout() const { return array.parameters.readout; }
  /// While acquisitions stream in.
  [[nodiscard]] double mw(double clock_hz) const;
  [[nodiscard]] double frames_per_s(double clock_hz) const { return clock_hz / static_cast<double>(clocks); }
};

/// Whether each limit is kept.
struct LimitsKept {
  bool area;
  bool power;
  bool frame;  ///< the frame rate at the clock
  bool clock;  ///< the clock in the slow corner

  [[nodiscard]] bool all() const { return area && power && frame && clock; }
};
LimitsKept limits_kept(const DesignCandidate& candidate, const DesignLimits& limits);

/// Every legal choice of the parameters that are searched, of read-outs that have RTL: NB, COUNT_WIDTH,
/// FRACTION_BITS, WINDOW_CENTRED and CELL_SHIFT around default_parameters, each from fewest to most SLOTS.
std::vector<ReadoutParameters> searched_parameters(const SensorModel& sensor);

/// The sensor's array; where it is too wide for the clock, as few arrays side by side as are fast enough, but
/// none narrower than the synthesised arrays that the estimates start from.
ArrayChoice array_for(const ReadoutParameters& parameters, const SensorModel& sensor, double clock_hz);

/// The sensor as a read-out of so many SLOTS sees it.
SensorModel with_slots(SensorModel sensor, int slots);

/// Options of `dtof product` and `dtof frame` that ask for the parameters, e.g. "--readout sifh --nb 5".
std::string command_options(const ReadoutParameters& parameters, const SensorModel& sensor);

}  // namespace dtof
