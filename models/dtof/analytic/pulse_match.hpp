// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/metrics/cramer_rao.hpp"
#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/readout/matched_filter.hpp"

namespace dtof {

/// Pulse and background that a pixel with these rates sees. Includes a measured or Gaussian pulse, jitter,
/// slots (more than 16 count as 16) and acquisitions. Dead time, afterpulsing and unequal codes are left out.
PulseObservation pulse_observation(const SensorModel& sensor, const PixelRates& rates);

/// Parameters of the filter matched to that pixel. All `rates` must be above 0.
MatchedFilterParameters matched_to(const SensorModel& sensor, const PixelRates& rates);

}  // namespace dtof
