// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/intensity_image.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include "dtof/core/random.hpp"

namespace dtof {

IntensityImage draw_intensity_image(const SensorModel& sensor, const TargetMap& targets, double klux,
                                    std::uint64_t seed) {
  sensor.validate();
  targets.validate();
  IntensityImage image{targets.columns(), targets.rows(), {}};
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      const double mean = static_cast<double>(sensor.acquisitions) *
                          sensor.background_events(klux, targets.at(column, row).reflectivity);
      CounterRandom random(seed, static_cast<std::uint32_t>(RandomPurpose::kIntensityImage),
                           static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(column));
      image.values.push_back(mean > 0.0 ? std::poisson_distribution<int>(mean)(random) : 0.0);
    }
  }
  return image;
}

std::vector<double> brightness(const IntensityImage& image) {
  const double sum = std::accumulate(image.values.begin(), image.values.end(), 0.0);
  const double mean = sum > 0.0 ? sum / static_cast<double>(image.values.size()) : 1.0;
  std::vector<double> roots;
  roots.reserve(image.values.size());
  for (const double value : image.values) {
    roots.push_back(std::sqrt(value / mean));
  }
  return roots;
}

}  // namespace dtof
