// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/linearised_average.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

class LinearisedAverage final : public Rival {
 public:
  LinearisedAverage(const SensorModel& sensor, int count_bits)
      : sensor_(sensor), count_bits_(count_bits), no_detection_((1 << sensor.np) - 1) {}

  [[nodiscard]] int bits_per_pixel() const override { return 2 * sensor_.np + 2 * count_bits_; }
  /// The timestamp is compared with L.
  [[nodiscard]] RivalHardware hardware() const override {
    return {.word_bits = bits_per_pixel(), .adder_bits = sensor_.np};
  }
  [[nodiscard]] int host_operations() const override { return 12; }
  [[nodiscard]] int frames() const override { return 2; }
  [[nodiscard]] int laser_off_frames() const override { return 1; }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    const Accepted background = sweep(frames[0]);
    const Accepted lit = sweep(frames[1]);
    return {lit.count, lit.sum, background.count};
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    const double acquisitions = sensor_.acquisitions;
    const double middle = 0.5 * (no_detection_ - 1);
    const double accepted = words[0];
    const double sweeps_of_each =
        std::max(1.0, acquisitions - accepted) / std::max(1.0, acquisitions - words[2]);
    const double background = words[2] * sweeps_of_each;
    const double signal = accepted - background;
    if (!(signal > 0.0)) {
      return {middle, 0.0};
    }
    const double noise = std::sqrt(accepted + background * sweeps_of_each);
    return {std::clamp((words[1] - background * middle) / signal, 0.0, no_detection_ - 1.0), signal / noise};
  }

 private:
  struct Accepted {
    std::int32_t count = 0;  ///< n
    std::int32_t sum = 0;    ///< s
  };

  [[nodiscard]] Accepted sweep(std::span<const Detection> detections) const {
    check_rival_frame(detections, sensor_);
    Accepted accepted;
    std::int32_t last = -1;  // L
    std::uint32_t next = 0;  // acquisition
    for (std::size_t i = 0; i < detections.size();) {
      const std::uint32_t acquisition = detections[i].acquisition;
      const std::int32_t armed_after =
          acquisition == next ? last : -1;  // one without detections ends a sweep
      last = -1;
      for (; i < detections.size() && detections[i].acquisition == acquisition; ++i) {
        const std::int32_t code = detections[i].timestamp;
        if (last < 0 && code != no_detection_ && code > armed_after) {
          last = code;
          ++accepted.count;
          accepted.sum += code;
        }
      }
      next = acquisition + 1;
    }
    return accepted;
  }

  SensorModel sensor_;
  int count_bits_;
  std::int32_t no_detection_;
};

}  // namespace

std::unique_ptr<Rival> make_linearised_average(const SensorModel& sensor) {
  constexpr int kMostSumBits = 31;
  const int count_bits = std::bit_width(sensor.acquisitions);
  if (sensor.np + count_bits > kMostSumBits) {
    throw InputError(fmt::format("linearised average: a sum of {} bits, but it must be at most {}",
                                 sensor.np + count_bits, kMostSumBits));
  }
  return std::make_unique<LinearisedAverage>(sensor, count_bits);
}

}  // namespace dtof
