// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/readout/histogram.hpp"

namespace dtof {

/// Probability of every result position of one pixel, computed without random numbers. The index is
/// (code << FRACTION_BITS) | fraction; the sum is 1 up to rounding.
///
/// Expected detections (photon/expected_detections.hpp) are exact. Two approximations follow:
///  - Histogram read-outs: counts of different bins are independent Poisson numbers. The peak's distribution
///    follows exactly, pass by pass, with full bins and ties.
///  - Pointer read-outs: the pointer is a Markov chain with one move per acquisition and slot. The slots of
///    one acquisition are independent.
/// Throws InputError for illegal parameters, for SLOTS or NP other than the sensor's, and for a sensor with
/// dead time, binning or coincidence.
std::vector<double> code_distribution(const SensorModel& sensor, const PixelRates& rates,
                                      const ReadoutParameters& parameters);

/// Error statistics (spec section 5, before the look-up table) of a distribution of positions.
struct PredictedErrors {
  double relative_precision;      ///< standard deviation of |measured - true| / true (Eq. 3.14)
  double bias_m;                  ///< mean of measured - true
  double standard_deviation_m;    ///< of measured - true
  double share_above_3_percent;   ///< share of |measured - true| > 3 % of true
  double share_above_10_percent;  ///< outlier rate: share of |measured - true| > 10 % of true
};
/// Errors of `distribution` (from code_distribution) for a target at `distance_m` > 0.
PredictedErrors predict_errors(const std::vector<double>& distribution, const SensorModel& sensor,
                               const ReadoutParameters& parameters, double distance_m);

/// Probability that each bin is the peak: the largest count, the lowest index on a tie, bin 0 if all counts
/// are 0. Counts are independent Poisson numbers with these `means` at the end of the pass. A bin is full at
/// `limit` >= 1.
std::vector<double> peak_distribution(const std::vector<double>& means, unsigned limit, FullBin full);

}  // namespace dtof
