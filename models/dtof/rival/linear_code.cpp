// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/linear_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/rival/code_matcher.hpp"

namespace dtof {
namespace {

class LinearCodePixel final : public Rival {
 public:
  LinearCodePixel(const SensorModel& sensor, LinearCode code)
      : sensor_(sensor),
        code_(std::move(code)),
        most_((std::int32_t{1} << static_cast<unsigned>(code_.count_bits - (code_.is_signed ? 1 : 0))) - 1),
        least_(code_.is_signed ? -most_ : 0),
        matcher_(sensor, code_.weights, code_.counters) {
    for (const std::int16_t weight : code_.weights) {
      largest_weight_ = std::max(largest_weight_, std::abs(std::int32_t{weight}));
    }
  }

  [[nodiscard]] int bits_per_pixel() const override {
    return static_cast<int>(code_.counters) * code_.count_bits +
           (code_.full == FullCounter::kFreezes ? 1 : 0);
  }
  [[nodiscard]] RivalHardware hardware() const override {
    return {.word_bits = bits_per_pixel(), .table_bits = code_.table_bits};
  }
  [[nodiscard]] int host_operations() const override { return matcher_.operations(); }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    const auto no_detection = static_cast<Timestamp>((1 << sensor_.np) - 1);
    RivalWords sums(code_.counters, 0);
    std::int32_t sure = 0;  // detections that cannot carry any counter over its limit
    for (const Detection& detection : frames.back()) {
      if (detection.timestamp == no_detection) {
        continue;
      }
      const std::int16_t* const weights = code_.weights.data() + detection.timestamp * code_.counters;
      if (sure == 0) {
        sure = sure_detections(sums);
      }
      if (sure > 0) {
        --sure;
        for (std::size_t k = 0; k < sums.size(); ++k) {
          sums[k] += weights[k];
        }
      } else if (!add_near_limit(sums, weights)) {
        break;
      }
    }
    return sums;
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return matcher_.decode(words);
  }
  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const override {
    return matcher_.evidence(words);
  }

 private:
  [[nodiscard]] std::int32_t sure_detections(const RivalWords& sums) const {
    const auto [low, high] = std::ranges::minmax(sums);
    const std::int32_t room = code_.is_signed ? std::min(most_ - high, low - least_) : most_ - high;
    return room / largest_weight_;
  }

  /// False if the pixel is frozen.
  bool add_near_limit(RivalWords& sums, const std::int16_t* weights) const {
    const auto next = [&](std::size_t k) { return sums[k] + weights[k]; };
    if (code_.full == FullCounter::kFreezes) {
      for (std::size_t k = 0; k < sums.size(); ++k) {
        if (next(k) > most_ || next(k) < least_) {
          return false;
        }
      }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
      sums[k] = std::clamp(next(k), least_, most_);
    }
    return true;
  }

  SensorModel sensor_;
  LinearCode code_;
  std::int32_t most_;
  std::int32_t least_;
  std::int32_t largest_weight_ = 1;
  CodeMatcher matcher_;
};

/// The lowest `bits` of a number in reverse order: over successive numbers it is spread evenly.
std::int32_t reversed_bits(std::uint32_t number, unsigned bits) {
  std::uint32_t reversed = 0;
  for (unsigned bit = 0; bit < bits; ++bit) {
    reversed = (reversed << 1U) | ((number >> bit) & 1U);
  }
  return static_cast<std::int32_t>(reversed);
}

class TwoCorrelations final : public Rival {
 public:
  TwoCorrelations(const SensorModel& sensor, int shift)
      : sensor_(sensor),
        shift_(static_cast<unsigned>(shift)),
        weights_(waves(sensor.np)),
        matcher_(sensor, weights_, 2) {}

  [[nodiscard]] int bits_per_pixel() const override { return 2 * (4 + static_cast<int>(shift_)); }
  /// The waves are the timestamp's own bits; what leaks away is one more sum for each average.
  [[nodiscard]] RivalHardware hardware() const override {
    return {.word_bits = bits_per_pixel(), .adder_bits = bits_per_pixel()};
  }
  [[nodiscard]] int host_operations() const override { return matcher_.operations(); }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    const int no_detection = (1 << sensor_.np) - 1;
    RivalWords averages(2, 0);
    for (const Detection& detection : frames.back()) {
      if (detection.timestamp != no_detection) {
        const std::int32_t dither = reversed_bits(detection.acquisition, shift_);
        for (std::size_t k = 0; k < 2; ++k) {
          averages[k] +=
              weights_[std::size_t{detection.timestamp} * 2 + k] - ((averages[k] + dither) >> shift_);
        }
      }
    }
    return averages;
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return matcher_.decode(words);
  }
  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const override {
    return matcher_.evidence(words);
  }

 private:
  static std::vector<std::int16_t> waves(int np) {
    constexpr double kHeight = 7.0;
    const int codes = 1 << np;
    std::vector<std::int16_t> weights;
    for (int x = 0; x < codes; ++x) {
      for (const double delay : {0.0, 0.25}) {
        const double turn = (x + 0.5) / codes - delay;
        const double away = std::abs(turn - std::round(turn));  // 0 at the wave's top, 1/2 at its bottom
        weights.push_back(static_cast<std::int16_t>(std::lround(kHeight * (1.0 - 4.0 * away))));
      }
    }
    return weights;
  }

  SensorModel sensor_;
  unsigned shift_;
  std::vector<std::int16_t> weights_;
  CodeMatcher matcher_;
};

/// Bits of the tables: a quarter of each wave is enough, and a wave of one bit is a bit of a multiple of the
/// timestamp.
int quarter_waves(int np, std::size_t waves, int bits) {
  return bits == 1 ? 0 : static_cast<int>(waves) * bits * (1 << (np - 2));
}

void add_harmonic(std::vector<CodeWave>& waves, int harmonic, std::size_t counters) {
  for (const CodeWave wave : {CodeWave{harmonic, false}, CodeWave{harmonic, true}}) {
    if (waves.size() < counters && std::ranges::find(waves, wave) == waves.end()) {
      waves.push_back(wave);
    }
  }
}

}  // namespace

std::unique_ptr<Rival> make_linear_code(const SensorModel& sensor, LinearCode code) {
  if (code.counters == 0 || code.weights.size() != code.counters << static_cast<unsigned>(sensor.np) ||
      code.count_bits < 2 || code.count_bits > 24) {
    throw InputError(fmt::format(
        "linear code: {} numbers for {} counters of {} bits, but it must be 2^NP for each, and 2 to 24 bits",
        code.weights.size(), code.counters, code.count_bits));
  }
  return std::make_unique<LinearCodePixel>(sensor, std::move(code));
}

std::vector<CodeWave> truncated_fourier(int counters) {
  std::vector<CodeWave> waves;
  for (int harmonic = 1; waves.size() < static_cast<std::size_t>(counters); ++harmonic) {
    add_harmonic(waves, harmonic, static_cast<std::size_t>(counters));
  }
  return waves;
}

std::vector<CodeWave> gray_fourier(int counters, int largest_harmonic) {
  std::vector<CodeWave> waves;
  const auto wanted = static_cast<std::size_t>(counters);
  for (int harmonic = 1; harmonic < largest_harmonic && waves.size() < wanted; harmonic *= 2) {
    add_harmonic(waves, harmonic, wanted);
  }
  for (int harmonic = 1; waves.size() < wanted; ++harmonic) {
    add_harmonic(waves, harmonic, wanted);
  }
  return waves;
}

int largest_harmonic(const SensorModel& sensor) {
  const double sigma = sensor.pulse_sigma_s() / sensor.time_resolution_s();
  return std::max(1, static_cast<int>(std::ldexp(1.0, sensor.np) / (4.0 * sigma)));
}

std::vector<std::int16_t> wave_weights(int np, std::span<const CodeWave> waves, int bits) {
  if (bits < 1 || bits > 12) {
    throw InputError(fmt::format("code of {} bits, but it must be 1 to 12", bits));
  }
  const int codes = 1 << np;
  const double height = (1 << (bits - 1)) - 1;
  std::vector<std::int16_t> weights;
  for (int x = 0; x < codes; ++x) {
    for (const CodeWave& wave : waves) {
      const double angle = 2.0 * std::numbers::pi * wave.harmonic * (x + 0.5) / codes;
      const double value = wave.sine ? std::sin(angle) : std::cos(angle);
      weights.push_back(
          static_cast<std::int16_t>(bits == 1 ? (value < 0.0 ? -1 : 1) : std::lround(height * value)));
    }
  }
  return weights;
}

std::unique_ptr<Rival> make_fourier(const SensorModel& sensor, std::span<const CodeWave> waves, int bits) {
  constexpr int kSignBits = 10;
  return make_linear_code(sensor, {.counters = waves.size(),
                                   .weights = wave_weights(sensor.np, waves, bits),
                                   .count_bits = kSignBits + bits - 1,
                                   .is_signed = true,
                                   .table_bits = quarter_waves(sensor.np, waves.size(), bits)});
}

std::unique_ptr<Rival> make_sketch(const SensorModel& sensor, int size) {
  constexpr int kCodeBits = 8;
  const double most = std::ldexp(1.0, kCodeBits - 1) * sensor.acquisitions * sensor.slots;
  const std::vector<CodeWave> waves = truncated_fourier(2 * size);
  return make_linear_code(sensor,
                          {.counters = waves.size(),
                           .weights = wave_weights(sensor.np, waves, kCodeBits),
                           .count_bits = std::min(24, static_cast<int>(std::ceil(std::log2(most))) + 1),
                           .is_signed = true,
                           .full = FullCounter::kStays,
                           .table_bits = quarter_waves(sensor.np, waves.size(), kCodeBits)});
}

std::vector<std::int16_t> spline_weights(int np, int knots) {
  constexpr int kParts = 4;
  const int codes = 1 << np;
  const auto counters = static_cast<std::size_t>(knots);
  std::vector<std::int16_t> weights(counters * static_cast<std::size_t>(codes), 0);
  for (int x = 0; x < codes; ++x) {
    const double place = (x + 0.5) * knots / codes;
    const auto knot = static_cast<std::size_t>(place);
    const auto part = static_cast<std::int16_t>(std::lround(kParts * (place - static_cast<double>(knot))));
    std::int16_t* const row = weights.data() + static_cast<std::size_t>(x) * counters;
    row[knot] = static_cast<std::int16_t>(row[knot] + kParts - part);
    row[(knot + 1) % counters] = static_cast<std::int16_t>(row[(knot + 1) % counters] + part);
  }
  return weights;
}

std::unique_ptr<Rival> make_spline_sketch(const SensorModel& sensor, int knots, int count_bits) {
  if (knots < 2) {
    throw InputError(fmt::format("spline sketch: {} knots, but it must be at least 2", knots));
  }
  return make_linear_code(sensor, {.counters = static_cast<std::size_t>(knots),
                                   .weights = spline_weights(sensor.np, knots),
                                   .count_bits = count_bits,
                                   .is_signed = false});
}

std::unique_ptr<Rival> make_two_correlations(const SensorModel& sensor, int shift) {
  if (shift < 1 || shift > 24) {
    throw InputError(
        fmt::format("two correlations: an average over 2^{}, but it must be 2^1 to 2^24", shift));
  }
  return std::make_unique<TwoCorrelations>(sensor, shift);
}

}  // namespace dtof
