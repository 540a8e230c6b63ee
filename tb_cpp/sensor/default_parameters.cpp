// SPDX-License-Identifier: Apache-2.0
#include "sensor/default_parameters.hpp"

#include <cmath>

namespace dtof {

ReadoutParameters default_parameters(Readout readout, const SensorModel& sensor) {
  ReadoutParameters parameters = ReadoutParameters::defaults(readout, sensor.np);
  parameters.slots = sensor.slots;
  if (readout == Readout::kHisPointer) {
    parameters.guard = static_cast<int>(std::ceil(sensor.pulse_fwhm_s / sensor.time_resolution_s()));
  }
  return parameters;
}

}  // namespace dtof
