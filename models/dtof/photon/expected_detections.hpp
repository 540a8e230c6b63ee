// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Mean detections of a pixel per acquisition and TDC code, pile-up included. result[slot][code] has SLOTS
/// slots and 2^NP codes; the last code is "no detection". A measured pulse, jitter and TDC code widths (of
/// the first table) are included.
///
/// With C(t) the mean number of events before t, slot k's event (k from 0) is before t with probability P(N >
/// k), N Poisson with mean C(t). This is exact at any rate. Throws InputError for a sensor with dead time,
/// afterpulsing, binning or coincidence.
std::vector<std::vector<double>> expected_slot_detections(const SensorModel& model, const PixelRates& rates);

/// Sum of expected_slot_detections over the slots: result[code].
std::vector<double> expected_detections(const SensorModel& model, const PixelRates& rates);

}  // namespace dtof
