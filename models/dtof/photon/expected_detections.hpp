// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Mean detections of a pixel per acquisition and TDC code, pile-up included: result[slot][code] for SLOTS
/// slots and 2^NP codes; the last code is "no detection". A measured pulse, jitter and TDC code widths (those
/// of the first table) are known. With C(t) the mean number of events before t, slot k's event (k from 0) is
/// before t with P(N > k), N Poisson with mean C(t). Exact, at any rate, but for dead time, afterpulsing,
/// binning and coincidence, which it does not know (InputError).
std::vector<std::vector<double>> expected_slot_detections(const SensorModel& model, const PixelRates& rates);

/// The sum over the slots.
std::vector<double> expected_detections(const SensorModel& model, const PixelRates& rates);

}  // namespace dtof
