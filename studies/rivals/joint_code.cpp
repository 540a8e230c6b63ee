// SPDX-License-Identifier: Apache-2.0
#include "rivals/joint_code.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "dtof/core/parallel.hpp"
#include "dtof/core/random.hpp"
#include "dtof/rival/harmonic_code.hpp"

namespace dtof {
namespace {

using Wave = std::complex<double>;

double turn_of(const LaserLimits& limits) { return 2.0 * std::numbers::pi / limits.codes; }

/// What the low-pass leaves of a harmonic's amplitude.
double passed(const LaserLimits& limits, int harmonic) {
  const double angle = turn_of(limits) * harmonic * limits.blur;
  return std::exp(-0.5 * angle * angle);
}

/// Table of the waves exp(-2 pi i h n / codes).
class Waves {
 public:
  explicit Waves(const LaserLimits& limits) {
    for (int n = 0; n < limits.codes; ++n) {
      values_.push_back(std::polar(1.0, -turn_of(limits) * n));
    }
  }

  [[nodiscard]] Wave at(int harmonic, std::size_t n) const {
    return values_[static_cast<std::size_t>(harmonic) * n % values_.size()];
  }
  /// Spectrum of a signal of the energy 1; 1 is all of the energy.
  [[nodiscard]] Wave spectrum(std::span<const double> signal, int harmonic) const {
    Wave sum = 0.0;
    for (std::size_t n = 0; n < signal.size(); ++n) {
      sum += signal[n] * at(harmonic, n);
    }
    return sum;
  }

 private:
  std::vector<Wave> values_;
};

/// Powers of the light at harmonics.
std::vector<double> light_powers(const LaserLimits& limits, const Waves& waves, std::span<const double> drive,
                                 std::span<const int> harmonics) {
  std::vector<double> powers;
  for (const int harmonic : harmonics) {
    powers.push_back(std::norm(passed(limits, harmonic) * waves.spectrum(drive, harmonic)));
  }
  return powers;
}

CodeConditions conditions_of(const LaserLimits& limits) {
  return {.codes = static_cast<double>(limits.codes),
          .sigma = limits.blur,
          .signal = limits.detections * limits.signal_share,
          .events = limits.detections};
}

/// The nearest signal that is at least 0, at most the peak, and has the energy 1.
std::vector<double> within_limits(const LaserLimits& limits, std::vector<double> drive) {
  const double most = limits.peak / limits.codes;
  const auto energy = [&](double shift) {
    return std::accumulate(drive.begin(), drive.end(), 0.0, [&](double sum, double value) {
      return sum + std::clamp(value - shift, 0.0, most);
    });
  };
  double low = *std::ranges::min_element(drive) - most;
  double high = *std::ranges::max_element(drive);
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (energy(middle) > 1.0 ? low : high) = middle;
  }
  std::ranges::transform(drive, drive.begin(),
                         [&](double value) { return std::clamp(value - high, 0.0, most); });
  return drive;
}

/// Search for light and harmonics.
class JointSearch {
 public:
  explicit JointSearch(const LaserLimits& limits)
      : limits_(limits), conditions_(conditions_of(limits)), waves_(limits) {
    constexpr double kNothing = 1e-3;
    while (largest_ < limits.codes / 2 - 1 && passed(limits, largest_) > kNothing) {
      ++largest_;
    }
  }

  /// Exchanges the harmonic whose exchange lowers the error most, until none does.
  void choose_harmonics(LaserCode& code) const {
    std::vector<int> all(static_cast<std::size_t>(largest_) + 1);
    std::iota(all.begin(), all.end(), 0);
    const std::vector<double> powers = light_powers(limits_, waves_, code.drive, all);
    const auto error = [&](std::span<const int> harmonics) {
      std::vector<double> chosen;
      for (const int harmonic : harmonics) {
        chosen.push_back(powers[static_cast<std::size_t>(harmonic)]);
      }
      return expected_square_error(conditions_, harmonics, chosen);
    };
    code.harmonics = best_replacements(std::move(code.harmonics), largest_, error);
  }

  /// Steps along the gradient of the error's logarithm, back into the limits, until no step lowers it.
  void shape_light(LaserCode& code) const {
    constexpr int kSteps = 200;
    constexpr double kLonger = 1.6;
    double length = 1e-3;
    double least = error_logarithm(code);
    for (int step = 0; step < kSteps; ++step) {
      const std::vector<double> direction = gradient(code);
      const std::optional<LaserCode> next = better_light(code, direction, least, length);
      if (!next) {
        return;
      }
      code = *next;
      least = error_logarithm(code);
      length *= kLonger;
    }
  }

  /// Takes turns of both searches; returns the logarithm of the error.
  double search(LaserCode& code) const {
    constexpr int kTurns = 6;
    constexpr double kBetter = 1e-4;
    double least = error_logarithm(code);
    for (int turn = 0; turn < kTurns; ++turn) {
      choose_harmonics(code);
      shape_light(code);
      const double found = error_logarithm(code);
      if (found > least - kBetter) {
        return found;
      }
      least = found;
    }
    return least;
  }

 private:
  [[nodiscard]] double error_logarithm(const LaserCode& code) const {
    return std::log(expected_square_error(conditions_, code.harmonics,
                                          light_powers(limits_, waves_, code.drive, code.harmonics)));
  }

  /// Direction in which the error's logarithm grows, as a unit vector.
  [[nodiscard]] std::vector<double> gradient(const LaserCode& code) const {
    constexpr double kDifference = 1e-5;
    const std::vector<double> powers = light_powers(limits_, waves_, code.drive, code.harmonics);
    const double here = std::log(expected_square_error(conditions_, code.harmonics, powers));
    std::vector<double> slope(code.drive.size(), 0.0);
    for (std::size_t i = 0; i < powers.size(); ++i) {
      std::vector<double> raised = powers;
      raised[i] += kDifference;
      const double by_power =
          (std::log(expected_square_error(conditions_, code.harmonics, raised)) - here) / kDifference;
      const int harmonic = code.harmonics[i];
      const double gain = passed(limits_, harmonic);
      const Wave factor = 2.0 * by_power * gain * gain * std::conj(waves_.spectrum(code.drive, harmonic));
      for (std::size_t n = 0; n < slope.size(); ++n) {
        slope[n] += std::real(factor * waves_.at(harmonic, n));
      }
    }
    const double all = std::sqrt(std::inner_product(slope.begin(), slope.end(), slope.begin(), 0.0));
    std::ranges::transform(slope, slope.begin(),
                           [all](double value) { return all > 0.0 ? value / all : 0.0; });
    return slope;
  }

  /// The longest step of `length`, `length` / 2, .. that lowers the error; `length` becomes that step's.
  [[nodiscard]] std::optional<LaserCode> better_light(const LaserCode& code,
                                                      std::span<const double> direction, double least,
                                                      double& length) const {
    constexpr int kHalvings = 20;
    constexpr double kLeastGain = 1e-7;
    for (int i = 0; i < kHalvings; ++i, length *= 0.5) {
      LaserCode tried = code;
      for (std::size_t n = 0; n < direction.size(); ++n) {
        tried.drive[n] -= length * direction[n];
      }
      tried.drive = within_limits(limits_, std::move(tried.drive));
      if (error_logarithm(tried) < least - kLeastGain) {
        return tried;
      }
    }
    return std::nullopt;
  }

  LaserLimits limits_;
  CodeConditions conditions_;
  Waves waves_;
  int largest_ = 1;  ///< largest of the harmonics that the low-pass leaves
};

/// Short pulses at random places: about as many codes as the energy needs, in groups of one 64th of the
/// range.
std::vector<double> random_pulses(const LaserLimits& limits, SplitMix64& random) {
  constexpr int kGroups = 64;
  const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1.0p-53; };
  std::vector<double> drive(static_cast<std::size_t>(limits.codes), 0.0);
  for (int group = 0; group < kGroups; ++group) {
    const double value = uniform() < 1.0 / limits.peak + 0.05 ? limits.peak / limits.codes : 0.0;
    const int begin = group * limits.codes / kGroups;
    const int end = (group + 1) * limits.codes / kGroups;
    for (int n = begin; n < end; ++n) {
      drive[static_cast<std::size_t>(n)] = value + 1e-6 * uniform();
    }
  }
  return within_limits(limits, std::move(drive));
}

LaserCode truncated_fourier_of_the_shortest_pulse(const LaserLimits& limits, std::size_t counters) {
  LaserCode code{shortest_pulse(limits), std::vector<int>(counters / 2)};
  std::iota(code.harmonics.begin(), code.harmonics.end(), 1);
  return code;
}

/// Counters of a code, and the place that fits them best.
class LaserCodeDecoder {
 public:
  LaserCodeDecoder(const LaserLimits& limits, const LaserCode& code)
      : codes_(static_cast<std::size_t>(limits.codes)), waves_(limits), harmonics_(code.harmonics) {
    for (const int harmonic : harmonics_) {
      light_.push_back(passed(limits, harmonic) * waves_.spectrum(code.drive, harmonic));
    }
  }

  void count(std::size_t timestamp, std::span<Wave> counters) const {
    for (std::size_t i = 0; i < harmonics_.size(); ++i) {
      counters[i] += waves_.at(harmonics_[i], timestamp);
    }
  }

  [[nodiscard]] double place(std::span<const Wave> counters) const {
    const std::size_t codes = codes_;
    std::vector<double> fit(codes, 0.0);
    for (std::size_t t = 0; t < codes; ++t) {
      for (std::size_t i = 0; i < harmonics_.size(); ++i) {
        fit[t] += std::real(std::conj(counters[i]) * light_[i] * waves_.at(harmonics_[i], t));
      }
    }
    const auto best = static_cast<std::size_t>(std::ranges::max_element(fit) - fit.begin());
    const double before = fit[(best + codes - 1) % codes];
    const double after = fit[(best + 1) % codes];
    const double bend = before - 2.0 * fit[best] + after;
    return static_cast<double>(best) + (bend < 0.0 ? 0.5 * (before - after) / bend : 0.0);
  }

 private:
  std::size_t codes_;
  Waves waves_;
  std::vector<int> harmonics_;
  std::vector<Wave> light_;
};

}  // namespace

std::vector<double> shortest_pulse(const LaserLimits& limits) {
  std::vector<double> drive(static_cast<std::size_t>(limits.codes), 0.0);
  double left = 1.0;
  for (double& value : drive) {
    value = std::min(left, limits.peak / limits.codes);
    left -= value;
  }
  return drive;
}

std::vector<double> blurred_light(const LaserLimits& limits, std::span<const double> drive) {
  const Waves waves(limits);
  std::vector<double> light(drive.size(), 1.0 / limits.codes);
  for (int harmonic = 1; harmonic < limits.codes / 2; ++harmonic) {
    const Wave share = 2.0 / limits.codes * passed(limits, harmonic) * waves.spectrum(drive, harmonic);
    for (std::size_t n = 0; n < light.size(); ++n) {
      light[n] += std::real(share * std::conj(waves.at(harmonic, n)));
    }
  }
  // What rounding leaves below 0 is no light.
  std::ranges::transform(light, light.begin(), [](double value) { return std::max(value, 0.0); });
  return light;
}

double expected_square_error(const LaserLimits& limits, const LaserCode& code) {
  return expected_square_error(conditions_of(limits), code.harmonics,
                               light_powers(limits, Waves(limits), code.drive, code.harmonics));
}

LaserCode best_code_of_the_shortest_pulse(const LaserLimits& limits, std::size_t counters) {
  LaserCode code = truncated_fourier_of_the_shortest_pulse(limits, counters);
  JointSearch(limits).choose_harmonics(code);
  return code;
}

LaserCode joint_code(const LaserLimits& limits, std::size_t counters, std::uint64_t seed) {
  constexpr int kRandomStarts = 3;
  const JointSearch search(limits);
  LaserCode best = best_code_of_the_shortest_pulse(limits, counters);
  double least = search.search(best);
  SplitMix64 random(
      CounterRandom(seed, static_cast<std::uint32_t>(RandomPurpose::kIndependentPhotons), 0, 2));
  for (int start = 0; start < kRandomStarts; ++start) {
    LaserCode tried = truncated_fourier_of_the_shortest_pulse(limits, counters);
    tried.drive = random_pulses(limits, random);
    if (const double found = search.search(tried); found < least) {
      least = found;
      best = tried;
    }
  }
  return best;
}

std::vector<double> laser_code_errors(const LaserLimits& limits, const LaserCode& code, std::size_t pixels,
                                      std::uint64_t seed, int threads) {
  const LaserCodeDecoder decoder(limits, code);
  std::vector<double> sums = blurred_light(limits, code.drive);
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  const double codes = limits.codes;
  const auto detections = static_cast<std::uint32_t>(std::lround(limits.detections));
  std::vector<double> errors(pixels);
  parallel_for(pixels, threads, [&](std::size_t pixel) {
    CounterRandom start(seed, static_cast<std::uint32_t>(RandomPurpose::kIndependentPhotons),
                        static_cast<std::uint32_t>(pixel), 3);
    const double place = start.uniform() * codes;
    SplitMix64 random(start);
    const auto uniform = [&] { return static_cast<double>(random() >> 11U) * 0x1.0p-53; };
    std::vector<Wave> counters(code.harmonics.size(), 0.0);
    for (std::uint32_t i = 0; i < detections; ++i) {
      double time = uniform() * codes;
      if (uniform() < limits.signal_share) {
        const auto bin = std::ranges::upper_bound(sums, uniform() * sums.back()) - sums.begin();
        time = place + static_cast<double>(bin) + uniform() - 0.5;
      }
      // A timestamp: the code in which the photon arrives. Code n is around n, as in the decoder.
      const auto timestamp = static_cast<std::size_t>(std::fmod(std::floor(time + 0.5) + codes, codes));
      decoder.count(timestamp, counters);
    }
    errors[pixel] = std::remainder(decoder.place(counters) - place, codes);
  });
  return errors;
}

}  // namespace dtof
