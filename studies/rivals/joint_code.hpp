// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace dtof {

/// Limits of a laser and its driver, and the photons for which a code is designed.
struct LaserLimits {
  int codes = 1024;    ///< codes of a timestamp; the light repeats after them
  double blur = 20.0;  ///< standard deviation, in codes, of the Gaussian low-pass of driver, laser and SPAD
  double peak = 10.0;  ///< largest power of the driver's signal over its mean, > 1 and at most `codes`
  double detections = 1000.0;  ///< of a pixel and frame
  double signal_share = 0.5;   ///< share of them that comes from the laser, > 0
};

/// Light of a laser that repeats, and a code of cosine and sine waves of a few harmonics.
struct LaserCode {
  std::vector<double> drive;   ///< share of the driver's energy in each code; the sum is 1
  std::vector<int> harmonics;  ///< each has two counters
};

/// The shortest pulse that `limits` allows: as strong as the peak, for as long as the energy lasts.
std::vector<double> shortest_pulse(const LaserLimits& limits);
/// The light that leaves the laser: the driver's signal behind the low-pass. The sum is 1.
std::vector<double> blurred_light(const LaserLimits& limits, std::span<const double> drive);

/// Expected squared error of a code, in codes: the equation of dtof/rival/harmonic_code.hpp with the spectrum
/// of the light in place of a pulse's.
double expected_square_error(const LaserLimits& limits, const LaserCode& code);

/// Optimises light and code together, as Parra et al. do (TPAMI 2025, arXiv 2510.12123): the driver's signal
/// is at least 0 and at most the peak, and behind the low-pass. In place of the paper's network this is the
/// project's own search, without training data. It lowers expected_square_error(): the light by projected
/// gradients, the harmonics by exchange, in turns; from the shortest pulse and from three patterns of random
/// short pulses. The result is a local optimum, so the paper's method may find a better one.
LaserCode joint_code(const LaserLimits& limits, std::size_t counters, std::uint64_t seed);
/// The best harmonics for the shortest pulse.
LaserCode best_code_of_the_shortest_pulse(const LaserLimits& limits, std::size_t counters);

/// Errors, in codes, of a code's position for pixels at places spread over the range. The position is that of
/// the largest correlation between the counters and those which the light gives at each place. Errors are
/// those of a circle: the range's end is its begin, too.
std::vector<double> laser_code_errors(const LaserLimits& limits, const LaserCode& code, std::size_t pixels,
                                      std::uint64_t seed, int threads);

}  // namespace dtof
