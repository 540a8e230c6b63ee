// SPDX-License-Identifier: Apache-2.0
#include "rivals/flux_photons.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace dtof {
namespace {

/// Mean detections of an acquisition in frame 0 or 1 of two; the laser is off in the first one.
double detections(const FluxPhotons& photons, std::size_t frame) {
  constexpr std::size_t kPixels = 50;
  const PlaceEstimator count = [frame](PixelFrames frames) {
    return static_cast<double>(frames[frame].size());
  };
  const PlaceErrors found = flux_errors(photons, {count}, kPixels, 1, 0, 2, 1);
  double sum = 0.0;
  for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
    sum += found.errors[0][pixel] + found.places[pixel];
  }
  return sum / kPixels / photons.acquisitions;
}

TEST(FluxPhotons, HaveTheRatesOfTheirSpad) {
  using Kept = FluxPhotons::Kept;
  const auto rate = [](Kept kept, double dead_time) {
    return detections({.signal_events = 0.5, .background_events = 2.0, .kept = kept, .dead_time = dead_time},
                      0);
  };
  constexpr double kSampling = 0.03;  // four standard deviations of 50,000 acquisitions are below this
  EXPECT_NEAR(rate(Kept::kAll, 0.5), 2.0, kSampling);
  EXPECT_NEAR(rate(Kept::kFreeRunning, 0.5), 2.0 / (1.0 + 2.0 * 0.5), kSampling);
  EXPECT_NEAR(rate(Kept::kFreeRunning, 1.5), 2.0 / (1.0 + 2.0 * 1.5), kSampling);
  EXPECT_NEAR(rate(Kept::kSynchronous, 1.0), 1.0 - std::exp(-2.0), kSampling);
}

TEST(FluxPhotons, TheFirstFramesHaveNoLaserLight) {
  const FluxPhotons photons{.signal_events = 0.5, .background_events = 0.0};
  EXPECT_EQ(detections(photons, 0), 0.0);
  EXPECT_NEAR(detections(photons, 1), 0.5, 0.02);
}

}  // namespace
}  // namespace dtof
