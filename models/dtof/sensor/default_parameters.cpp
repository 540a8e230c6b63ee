// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/default_parameters.hpp"

#include <cmath>

namespace dtof {

namespace {

// Beyond these FWHM, in coarse bins, the other windows read training scenes better
// (docs/reference/poolpointer.md).
constexpr double kShortPulse = 0.75;
constexpr double kLongPulse = 2.25;

}  // namespace

int pool_cell_shift(double fwhm_coarse_bins) {
  return fwhm_coarse_bins < kShortPulse ? 8 : fwhm_coarse_bins < kLongPulse ? 9 : 10;
}

ReadoutParameters default_parameters(Readout readout, const SensorModel& sensor) {
  ReadoutParameters parameters = ReadoutParameters::defaults(readout, sensor.np);
  parameters.slots = sensor.slots;
  if (readout == Readout::kHisPointer) {
    parameters.guard = static_cast<int>(std::ceil(sensor.pulse_fwhm_s / sensor.time_resolution_s()));
  }
  if (is_pool_readout(readout)) {
    parameters.pool.cell_shift = pool_cell_shift(sensor.pulse_fwhm_s / sensor.time_resolution_s() *
                                                 std::ldexp(1.0, parameters.nb - sensor.np));
  }
  return parameters;
}

std::string_view default_source(std::string_view parameter) {
  if (parameter == "NP") {
    return "the sensor's, 10 for a recording";
  }
  if (parameter == "SLOTS") {
    return "the sensor's";
  }
  if (parameter == "GUARD") {
    return "the pulse's FWHM in bins";
  }
  return parameter == "CELL_SHIFT" ? "follows from the pulse's FWHM" : "the read-out's own";
}

}  // namespace dtof
