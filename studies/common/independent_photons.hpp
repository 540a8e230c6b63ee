// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "dtof/photon/sensor_model.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

/// Photon statistics as in papers on compressed read-outs. A pixel has a fixed number of independent
/// detections, one per acquisition, so there is no pile-up. A detection belongs to the pulse (a Gaussian
/// around the pixel's position) with probability `signal_share`; else it is uniform over the range.
struct IndependentPhotons {
  int np = 10;                      ///< bits of a timestamp
  double pulse_sigma = 0.02;        ///< standard deviation of the pulse as a share of the range, > 0
  std::uint32_t detections = 1000;  ///< detections of a pixel per frame
  double signal_share = 0.5;        ///< 0 .. 1

  /// Ratio of signal to background detections.
  [[nodiscard]] double signal_to_background() const { return signal_share / (1.0 - signal_share); }
  /// A sensor with this pulse, for which rivals are made.
  [[nodiscard]] SensorModel sensor() const;
  /// Least standard deviation of an unbiased position estimate, in codes (metrics/cramer_rao.hpp).
  [[nodiscard]] double cramer_rao_bound() const;
};

/// Estimates the position of a pixel's frames (oldest first) on the code axis; 0 is the middle of code 0.
using PlaceEstimator = std::function<double(PixelFrames frames)>;
/// Estimator that applies a rival to the last frames, as many as it needs.
PlaceEstimator estimator_of(std::unique_ptr<Rival> rival);

struct PlaceErrors {
  std::vector<double> places;               ///< true position of each pixel, in codes
  std::vector<std::vector<double>> errors;  ///< [estimator][pixel], in codes
};

/// Errors of several estimators on the same photons. Positions are uniform over the range, except within five
/// standard deviations of the pulse from its ends. Throws InputError for shares outside their range.
PlaceErrors place_errors(const IndependentPhotons& photons, const std::vector<PlaceEstimator>& estimators,
                         std::size_t pixels, std::uint64_t seed, int threads, std::size_t frames = 1);

}  // namespace dtof
