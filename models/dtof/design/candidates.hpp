// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
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

/// Returns legal sets of the searched parameters, for read-outs that have RTL: every combination of NB,
/// COUNT_WIDTH, FRACTION_BITS, WINDOW_CENTRED, CELL_SHIFT and ENGINE_COLUMNS around default_parameters, and
/// of SLOTS; and with the default COUNT_WIDTH and CELL_SHIFT every combination of LABELS and GROUP_SIZE.
std::vector<ReadoutParameters> searched_parameters(const SensorModel& sensor);

/// Returns the parameters with which the models compare a candidate: an engine of at most as many columns as
/// the read-out's own, because a model reads whole engines. A wider engine has fewer borders, where pixels
/// lack neighbours, so that its errors are not larger.
ReadoutParameters compared_parameters(ReadoutParameters parameters);

/// Returns the arrays for the sensor that give the same results at different costs: 1, 2, 3, 4, 6, 8, 12 or
/// 16 columns of the sensor for each SRAM, as far as dtof_subsystem can number the pixels of an SRAM; for a
/// pool read-out 1 alone, because its columns help each other. Pointers are in memories of one port, which
/// are smaller, if SLOTS is at least 2. An array that is too slow for the clock is cut into the fewest equal
/// arrays side by side that are fast enough; arrays as narrow as the synthesised array on which the estimates
/// rest are not cut further. Leaves out arrays with a memory that cannot be made.
std::vector<ArrayChoice> arrays_for(const ReadoutParameters& parameters, const SensorModel& sensor,
                                    double clock_hz);

/// Returns all candidates for the sensor. `slots_taken`: share of the slots that hold a detection, for each
/// number of SLOTS from 1 to the sensor's.
std::vector<DesignCandidate> all_candidates(const SensorModel& sensor, double clock_hz,
                                            const std::map<int, double>& slots_taken);

/// Copy of the sensor with this number of slots.
SensorModel with_slots(SensorModel sensor, int slots);

/// Options of `dtof product` and `dtof frame` that select these parameters, e.g. "--readout sifh --nb 5".
std::string command_options(const ReadoutParameters& parameters, const SensorModel& sensor);
/// Options of `dtof product` that select this array.
std::string product_options(const ArrayChoice& array, const SensorModel& sensor);

}  // namespace dtof
