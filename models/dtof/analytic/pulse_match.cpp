// SPDX-License-Identifier: Apache-2.0
#include "dtof/analytic/pulse_match.hpp"

#include <algorithm>

namespace dtof {

PulseObservation pulse_observation(const SensorModel& sensor, const PixelRates& rates) {
  constexpr int kMostSlots = 16;  // more change nothing at rates that a bound can be computed for
  return {.signal_events = rates.signal,
          .background_events = rates.background,
          .centre_bins = rates.centre_bins,
          .sigma_bins = sensor.pulse_sigma_s() / sensor.time_resolution_s(),
          .np = sensor.np,
          .acquisitions = static_cast<double>(sensor.acquisitions),
          .kept_events = std::min(sensor.slots, kMostSlots),
          .response = sensor.pulse_response_bins()};
}

MatchedFilterParameters matched_to(const SensorModel& sensor, const PixelRates& rates) {
  return {.np = sensor.np,
          .sigma_bins = sensor.pulse_sigma_s() / sensor.time_resolution_s(),
          .signal_events = rates.signal,
          .background_events = rates.background,
          .response = sensor.pulse_response_bins()};
}

}  // namespace dtof
