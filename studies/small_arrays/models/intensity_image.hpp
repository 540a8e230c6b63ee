// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"

namespace dtof {

/// A picture of the large array's size that guides an enlarger.
struct IntensityImage {
  int columns = 0;
  int rows = 0;
  std::vector<double> values;  ///< [row][column], at least 0
};

/// What a passive camera of the sensor's pixels sees in one frame: of each pixel a Poisson number of events
/// whose mean is the background of all acquisitions (sunlight that the target reflects, and dark counts).
/// Random numbers depend on seed and pixel alone. Throws InputError for illegal physics.
IntensityImage draw_intensity_image(const SensorModel& sensor, const TargetMap& targets, double klux,
                                    std::uint64_t seed);

/// Square root of each value over the image's mean: free of the exposure, and of equal noise everywhere,
/// since that of a number of photons is its root. An image that is 0 everywhere stays so.
std::vector<double> brightness(const IntensityImage& image);

}  // namespace dtof
