// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

/// One detection per timestamp, in acquisitions 0, 1, 2 and so on.
inline std::vector<Detection> one_each(std::span<const int> timestamps) {
  std::vector<Detection> detections;
  for (const int timestamp : timestamps) {
    detections.push_back({static_cast<std::uint32_t>(detections.size()), static_cast<Timestamp>(timestamp)});
  }
  return detections;
}

/// Words of a pixel after one frame.
inline RivalWords read_one_frame(const Rival& rival, std::span<const Detection> detections) {
  return rival.read_pixel(std::vector<std::span<const Detection>>{detections});
}

/// A frame without noise. Code x has round(events g(x)) detections of a pulse with its mean in the middle of
/// code `centre`, plus `floor`. The order makes any part of the frame similar to the whole.
inline std::vector<Detection> noise_free_pulse(const SensorModel& sensor, double centre, double events,
                                               int floor) {
  const double sigma = sensor.pulse_sigma_s() / sensor.time_resolution_s();
  std::vector<int> timestamps;
  const int codes = (1 << sensor.np) - 1;
  for (int x = 0; x < codes; ++x) {
    const double z = (x - centre) / sigma;
    const double mean = events / (sigma * 2.5066282746) * std::exp(-0.5 * z * z);
    timestamps.insert(timestamps.end(),
                      static_cast<std::size_t>(std::lround(mean)) + static_cast<std::size_t>(floor), x);
  }
  // A stride without a common factor with the number always shuffles in the same way.
  std::vector<int> shuffled;
  std::size_t stride = timestamps.size() * 618 / 1000 | 1U;
  while (!timestamps.empty() && std::gcd(stride, timestamps.size()) != 1) {
    stride += 2;
  }
  for (std::size_t i = 0; i < timestamps.size(); ++i) {
    shuffled.push_back(timestamps[i * stride % timestamps.size()]);
  }
  return one_each(shuffled);
}

}  // namespace dtof
