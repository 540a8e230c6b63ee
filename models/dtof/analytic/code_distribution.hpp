// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/readout/histogram.hpp"

namespace dtof {

/// Probability of every position of a read-out's result for one pixel, without random numbers:
/// result[code << FRACTION_BITS | fraction], sum 1 but for rounding.
///
/// Expected detections (photon/expected_detections.hpp) are exact; then
///  - histogram read-outs: counts of different bins are taken as independent Poisson numbers, and the peak's
///    distribution follows exactly (full bins and ties included), pass by pass;
///  - pointer read-outs: the pointer is a Markov chain that makes one move per acquisition and slot; the
///  slots
///    of one acquisition are taken as independent.
/// Throws InputError for illegal parameters, SLOTS or NP other than the sensor's, dead time, binning or
/// coincidence.
std::vector<double> code_distribution(const SensorModel& sensor, const PixelRates& rates,
                                      const ReadoutParameters& parameters);

/// Error statistics (spec section 5, before the look-up table) of a distribution of positions.
struct PredictedErrors {
  double relative_precision;      ///< standard deviation of |measured - true| / true (Eq. 3.14)
  double bias_m;                  ///< mean of measured - true
  double standard_deviation_m;    ///< of measured - true
  double share_above_3_percent;   ///< of |measured - true| > 3 % of true
  double share_above_10_percent;  ///< outlier rate
};
/// `distance_m` > 0.
PredictedErrors predict_errors(const std::vector<double>& distribution, const SensorModel& sensor,
                               const ReadoutParameters& parameters, double distance_m);

/// Probability of every bin to be the peak (largest count, lowest index on a tie, 0 if all are 0) of a
/// histogram whose counts are independent Poisson processes with these means at their end, and full at
/// `limit` >= 1.
std::vector<double> peak_distribution(const std::vector<double>& means, unsigned limit, FullBin full);

}  // namespace dtof
