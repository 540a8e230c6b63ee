// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "dtof/photon/sensor_model.hpp"
#include "rivals/models/rival.hpp"

namespace dtof {

/// Photons as papers on compressed read-outs have them: a pixel sees a fixed number of detections,
/// independent of each other and one in each acquisition, so that there is no pile-up. Each is of the pulse,
/// a Gaussian around the pixel's place, with probability `signal_share`, else anywhere in the range.
struct IndependentPhotons {
  int np = 10;                      ///< bits of a timestamp
  double pulse_sigma = 0.02;        ///< of the range, > 0
  std::uint32_t detections = 1000;  ///< of a pixel in a frame
  double signal_share = 0.5;        ///< 0 .. 1

  /// Signal over background detections.
  [[nodiscard]] double signal_to_background() const { return signal_share / (1.0 - signal_share); }
  /// A sensor of this pulse, for which rivals are made.
  [[nodiscard]] SensorModel sensor() const;
  /// The least standard deviation of any unbiased estimate of the place, in codes (metrics/cramer_rao.hpp).
  [[nodiscard]] double cramer_rao_bound() const;
};

/// Puts a pixel's frames, the oldest first, at a place on the code axis: 0 is the middle of code 0.
using PlaceEstimator = std::function<double(PixelFrames frames)>;
/// What a rival says of the last frames, as many as it needs.
PlaceEstimator estimator_of(std::unique_ptr<Rival> rival);

struct PlaceErrors {
  std::vector<double> places;               ///< of each pixel, in codes
  std::vector<std::vector<double>> errors;  ///< [estimator][pixel], in codes
};

/// All estimators see the same photons. Places are uniform over the range but for the five standard
/// deviations of the pulse nearest to its ends. Throws InputError for shares outside their range.
PlaceErrors place_errors(const IndependentPhotons& photons, const std::vector<PlaceEstimator>& estimators,
                         std::size_t pixels, std::uint64_t seed, int threads, std::size_t frames = 1);

}  // namespace dtof
