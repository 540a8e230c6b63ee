// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/optimised_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "dtof/core/error.hpp"
#include "dtof/rival/pulse_shape.hpp"

namespace dtof {
namespace {

constexpr int kNumberBits = 4;
constexpr std::array kDesignKlux = {2.0, 14.0, 50.0};

/// What E depends on besides the harmonics.
struct CodeDesign {
  double codes;
  double sigma;   ///< of the pulse, in codes
  double signal;  ///< S
  double events;  ///< N

  CodeDesign(const SensorModel& sensor, double klux)
      : codes(std::ldexp(1.0, sensor.np)), sigma(PulseShape(sensor).sigma()) {
    constexpr double kLightSpeed = 299'792'458.0;
    const double half_range_m = 0.25 * kLightSpeed * sensor.integration_time_s;
    signal = sensor.acquisitions * sensor.signal_events(half_range_m, 1.0);
    events = signal + sensor.acquisitions * sensor.background_events(klux, 1.0);
  }

  [[nodiscard]] double error(std::span<const int> harmonics) const {
    const double turn = 2.0 * std::numbers::pi / codes;
    const double noise = std::sqrt(0.5 * events);
    std::vector<double> power;  // g^2
    double slope = 0.0;
    for (const int harmonic : harmonics) {
      const double angle = turn * harmonic * sigma;
      power.push_back(std::exp(-angle * angle));
      slope += power.back() * (turn * harmonic) * (turn * harmonic);
    }
    double sum = 0.5 * events / (signal * signal * slope);
    for (double x = 2.0 * sigma; x <= 0.5 * codes; x += 0.5 * sigma) {
      double square = 0.0;
      for (std::size_t i = 0; i < harmonics.size(); ++i) {
        square += 2.0 * power[i] * (1.0 - std::cos(turn * harmonics[i] * x));
      }
      const double half_way = 0.5 * signal * std::sqrt(square) / noise;
      sum += x * x * std::erfc(half_way / std::numbers::sqrt2);  // both signs: 2 Q
    }
    return sum;
  }
};

}  // namespace

double expected_square_error(const SensorModel& sensor, double klux, std::span<const int> harmonics) {
  return CodeDesign(sensor, klux).error(harmonics);
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
  double least = mean_square_error(sensor, best);
  for (bool better = true; better;) {
    better = false;
    const std::vector<int> from = best;
    for (std::size_t place = 0; place < from.size(); ++place) {
      for (int harmonic = 1; harmonic <= most; ++harmonic) {
        std::vector<int> tried = from;
        tried[place] = harmonic;
        const double error =
            std::ranges::count(from, harmonic) > 0 ? least : mean_square_error(sensor, tried);
        if (error < least) {
          least = error;
          best = tried;
          better = true;
        }
      }
    }
  }
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
