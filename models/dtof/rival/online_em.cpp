// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/online_em.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace dtof {
namespace {

constexpr std::size_t kStages = 7;
constexpr int kFractionBits = 6;
constexpr std::int64_t kLeastWeight = 65536 / 64;
constexpr std::array<unsigned, kStages> kGain = {4, 4, 5, 5, 6, 6, 7};

/// To nearest, halves away from zero; `divisor` > 0.
constexpr std::int64_t rounded_quotient(std::int64_t dividend, std::int64_t divisor) {
  return (dividend >= 0 ? dividend + divisor / 2 : dividend - divisor / 2) / divisor;
}

class OnlineEm final : public Rival {
 public:
  explicit OnlineEm(const SensorModel& sensor) : sensor_(sensor) {
    const double range = std::ldexp(1.0, sensor.np);
    const double pulse = sensor.pulse_sigma_s() / sensor.time_resolution_s();
    for (std::size_t stage = 0; stage < kStages; ++stage) {
      const double part = static_cast<double>(stage) / static_cast<double>(kStages - 1);
      const double sigma = 0.25 * range * std::pow(pulse / (0.25 * range), part);
      steps_[stage] = std::max<std::int32_t>(
          1, static_cast<std::int32_t>(std::lround(sigma * (1 << kFractionBits) / kStepsPerSigma)));
      for (std::size_t step = 0; step < kSteps; ++step) {
        const double z = (static_cast<double>(step) + 0.5) / kStepsPerSigma;
        densities_[stage][step] =
            std::lround(16.0 * range / (sigma * std::sqrt(2.0 * std::numbers::pi)) * std::exp(-0.5 * z * z));
      }
    }
  }

  [[nodiscard]] int bits_per_pixel() const override { return sensor_.np + kFractionBits + 16; }

  /// Products: w times the density (16 x 10 bits), the distance times r (16 x 8). Quotients: r (8 bits by
  /// 32), the step of mu (16 by 16).
  [[nodiscard]] RivalHardware hardware() const override {
    constexpr int kDensityBits = 10;
    return {.word_bits = bits_per_pixel(),
            .adder_bits = 16 * kDensityBits + 16 * 8 + 8 * 32 + 16 * 16,
            .table_bits = static_cast<int>(kStages * kSteps) * kDensityBits};
  }
  [[nodiscard]] int host_operations() const override { return 1; }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    const std::int32_t no_detection = (1 << sensor_.np) - 1;
    std::int64_t place = std::int64_t{1} << (sensor_.np - 1 + kFractionBits);
    std::int64_t weight = kLeastWeight;
    for (const Detection& detection : frames.back()) {
      if (detection.timestamp == no_detection) {
        continue;
      }
      const std::size_t stage = online_em_stage(detection.acquisition, sensor_.acquisitions);
      const std::int64_t away = (std::int64_t{detection.timestamp} << kFractionBits) - place;
      const auto step = static_cast<std::size_t>(std::abs(away) / steps_[stage]);
      const std::int64_t density = step < kSteps ? densities_[stage][step] : 0;
      const std::int64_t pulse = weight * density;
      const std::int64_t share = rounded_quotient(255 * pulse, pulse + (65536 - weight) * 16);  // r, of 255
      const std::int64_t gain = std::int64_t{1} << kGain[stage];
      place += rounded_quotient(away * share * 257, weight * gain);
      weight += rounded_quotient(257 * share - weight, gain);
      place = std::clamp<std::int64_t>(place, 0, (std::int64_t{1} << (sensor_.np + kFractionBits)) - 1);
      weight = std::max(weight, kLeastWeight);  // 65535 is never passed: r has 8 bits
    }
    return {static_cast<std::int32_t>(place), static_cast<std::int32_t>(weight)};
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    const double last = std::ldexp(1.0, sensor_.np) - 1.0;
    return {std::min(std::ldexp(words[0], -kFractionBits), last),
            static_cast<double>(words[1] - kLeastWeight)};
  }

 private:
  static constexpr std::size_t kSteps = 32;
  static constexpr double kStepsPerSigma = 8.0;

  SensorModel sensor_;
  std::array<std::int32_t, kStages> steps_{};  // of each stage's table, in units of mu
  std::array<std::array<std::int64_t, kSteps>, kStages> densities_{};
};

}  // namespace

std::size_t online_em_stage(std::uint32_t acquisition, std::uint32_t acquisitions) {
  constexpr std::size_t kEighths = 8;  // six stages of an eighth, the last of two
  return std::min<std::size_t>(std::uint64_t{acquisition} * kEighths / acquisitions, kStages - 1);
}

std::unique_ptr<Rival> make_online_em(const SensorModel& sensor) {
  return std::make_unique<OnlineEm>(sensor);
}

}  // namespace dtof
