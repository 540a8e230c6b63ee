// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dtof/rival/rival.hpp"

namespace dtof {

/// Effect of a counter at its limit on its pixel.
enum class FullCounter {
  kStays,  ///< this counter stays at its limit; others count on
  /// The detection that would exceed a limit is not counted, and neither are later ones of this frame. So the
  /// counters keep their proportion. The pixel stores a bit for this state.
  kFreezes,
};

/// A pixel whose counters add numbers of a code table for every detection, y[k] += C[k][x], and a host that
/// correlates (CodeMatcher). Examples are compressive histograms (Gutierrez-Barragan et al., CVPR 2022),
/// sketches (Sheehan, Tachella and Davies, arXiv 2102.08732) and the spline sketch (arXiv 2210.07314).
struct LinearCode {
  std::size_t counters;
  std::vector<std::int16_t> weights;  ///< weights[x * counters + k] is C[k][x], x = 0 .. 2^NP - 1
  int count_bits;                     ///< width of a counter, 2 .. 24, sign included
  bool is_signed;  ///< limits -2^(count_bits - 1) + 1 and 2^(count_bits - 1) - 1, else 0 and 2^count_bits - 1
  FullCounter full = FullCounter::kFreezes;
  int table_bits = 0;  ///< bits of the table in each column; 0: the numbers follow from the timestamp's bits
};
std::unique_ptr<Rival> make_linear_code(const SensorModel& sensor, LinearCode code);

/// A wave of a code: cos(2 pi harmonic (x + 1/2) / 2^NP), or the sine.
struct CodeWave {
  int harmonic;
  bool sine;

  bool operator==(const CodeWave&) const = default;
};

/// Truncated Fourier code of K counters: cosine and sine of the harmonics 1 .. K/2.
std::vector<CodeWave> truncated_fourier(int counters);
/// Gray-Fourier code of K counters: cosine and sine of the harmonics 1, 2, 4, .. below `largest_harmonic`,
/// which the pulse does not blur; then of the lowest unused harmonics.
std::vector<CodeWave> gray_fourier(int counters, int largest_harmonic);
/// The harmonic whose period is four standard deviations of the pulse.
int largest_harmonic(const SensorModel& sensor);

/// The waves as numbers of `bits` bits, sign included. 1 bit is the sign (+1 or -1); more bits are rounded to
/// -(2^(bits-1) - 1) .. 2^(bits-1) - 1.
std::vector<std::int16_t> wave_weights(int np, std::span<const CodeWave> waves, int bits);

/// Fourier codes of either kind. With one bit per number a counter has 10 bits, and one more for each further
/// bit.
std::unique_ptr<Rival> make_fourier(const SensorModel& sensor, std::span<const CodeWave> waves, int bits);

/// Sketch of size M: the truncated Fourier code with K = 2M, with the precision of its authors' hardware:
/// numbers of 8 bits, and counters that no frame fills.
std::unique_ptr<Rival> make_sketch(const SensorModel& sensor, int size);

/// Linear spline sketch on a circle. With x = (i + f) 2^NP / knots, 1 - f is added to counter i and f to the
/// next one, both in quarters.
std::unique_ptr<Rival> make_spline_sketch(const SensorModel& sensor, int knots, int count_bits);
std::vector<std::int16_t> spline_weights(int np, int knots);

/// Correlation-assisted dToF (Kuijk, Sensors 2025, 25(21) 6772): moving averages, over the detections, of two
/// triangular waves a quarter of the range apart. In integers, with a wave w[k] of -7 .. 7:
///
///     v[k] += w[k][x] - ((v[k] + d) >> shift)
///
/// So v is 2^shift times the average over about 2^shift detections. d is the acquisition's number with its
/// lowest `shift` bits in reverse order, equal in all pixels. With this dither exactly v / 2^shift is
/// subtracted on average. A constant d would leave averages below half a unit unchanged and quantise larger
/// ones: centimetres of error. Words have 4 + shift bits, with `shift` 1 .. 24.
std::unique_ptr<Rival> make_two_correlations(const SensorModel& sensor, int shift);

}  // namespace dtof
