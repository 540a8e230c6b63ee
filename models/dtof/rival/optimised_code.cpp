// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/optimised_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/rival/harmonic_code.hpp"
#include "dtof/rival/pulse_shape.hpp"

namespace dtof {
namespace {

constexpr int kNumberBits = 4;
constexpr std::array kDesignKlux = {2.0, 14.0, 50.0};

CodeConditions white_target_at_half_range(const SensorModel& sensor, double klux) {
  constexpr double kLightSpeed = 299'792'458.0;
  const double half_range_m = 0.25 * kLightSpeed * sensor.integration_time_s;
  const double signal = sensor.acquisitions * sensor.signal_events(half_range_m, 1.0);
  return {.codes = std::ldexp(1.0, sensor.np),
          .sigma = PulseShape(sensor).sigma(),
          .signal = signal,
          .events = signal + sensor.acquisitions * sensor.background_events(klux, 1.0)};
}

}  // namespace

double expected_square_error(const SensorModel& sensor, double klux, std::span<const int> harmonics) {
  const CodeConditions conditions = white_target_at_half_range(sensor, klux);
  const double turn = 2.0 * std::numbers::pi / conditions.codes;
  std::vector<double> powers;
  for (const int harmonic : harmonics) {
    const double angle = turn * harmonic * conditions.sigma;
    powers.push_back(std::exp(-angle * angle));
  }
  return expected_square_error(conditions, harmonics, powers);
}

double mean_square_error(const SensorModel& sensor, std::span<const int> harmonics) {
  double sum = 0.0;
  for (const double klux : kDesignKlux) {
    sum += std::log(expected_square_error(sensor, klux, harmonics));
  }
  return std::exp(sum / static_cast<double>(kDesignKlux.size()));
}

std::vector<int> optimised_harmonics(const SensorModel& sensor, int counters) {
  const int most = std::max(largest_harmonic(sensor), counters / 2);
  std::vector<int> best;
  for (const CodeWave& wave : gray_fourier(counters, largest_harmonic(sensor))) {
    if (wave.sine) {
      best.push_back(wave.harmonic);
    }
  }
  best = best_replacements(std::move(best), most, [&](std::span<const int> harmonics) {
    return mean_square_error(sensor, harmonics);
  });
  std::ranges::sort(best);
  return best;
}

std::vector<CodeWave> waves_of(std::span<const int> harmonics) {
  std::vector<CodeWave> waves;
  for (const int harmonic : harmonics) {
    waves.push_back({harmonic, false});
    waves.push_back({harmonic, true});
  }
  return waves;
}

std::unique_ptr<Rival> make_optimised_code(const SensorModel& sensor, int counters) {
  if (counters < 2 || counters > 32 || counters % 2 != 0) {
    throw InputError(
        fmt::format("optimised code: {} counters, but it must be an even number from 2 to 32", counters));
  }
  return make_fourier(sensor, waves_of(optimised_harmonics(sensor, counters)), kNumberBits);
}

}  // namespace dtof
