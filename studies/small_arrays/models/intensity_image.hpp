// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// A picture with the large array's size that guides an enlarger.
struct IntensityImage {
  int columns = 0;
  int rows = 0;
  std::vector<double> values;  ///< [row][column], at least 0
};

/// Image of a passive camera with the sensor's pixels, for one frame. Each pixel has a Poisson number of
/// events whose mean is the background of all acquisitions: reflected sunlight and dark counts. Random
/// numbers depend on seed and pixel alone. Throws InputError for illegal physics.
IntensityImage draw_intensity_image(const SensorModel& sensor, const TargetMap& targets, double klux,
                                    std::uint64_t seed);

/// Square root of each value divided by the image's mean. It is independent of exposure and has equal noise
/// everywhere, since the noise of a photon number is its square root. An image of zeros stays zero.
std::vector<double> brightness(const IntensityImage& image);

}  // namespace dtof
