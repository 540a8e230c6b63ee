// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "dtof/rival/linear_code.hpp"
#include "dtof/rival/rival.hpp"

namespace dtof {

/// A code of 4-bit numbers that is optimised for the sensor, in place of the learned code of Feng et al.
/// (IEEE Sensors Journal 2025, doi 10.1109/JSEN.2025.3575784), whose table and training data are not public.
/// It is this project's own optimisation, by a rule instead of a network and without random numbers.
///
/// The code has cosine and sine of counters / 2 harmonics. Its expected squared error E is that of
/// dtof/rival/harmonic_code.hpp with the spectrum of the pulse, for a white target at half of the range. The
/// search lowers the geometric mean of E in 2, 14 and 50 klux: it begins with the Gray-Fourier code, and
/// replaces the harmonic whose replacement lowers the mean most until none does.
std::vector<int> optimised_harmonics(const SensorModel& sensor, int counters);
/// E for a set of harmonics.
double expected_square_error(const SensorModel& sensor, double klux, std::span<const int> harmonics);
/// The geometric mean of E.
double mean_square_error(const SensorModel& sensor, std::span<const int> harmonics);

/// `counters`: 2 .. 32, even.
std::unique_ptr<Rival> make_optimised_code(const SensorModel& sensor, int counters);
/// Both waves of each harmonic.
std::vector<CodeWave> waves_of(std::span<const int> harmonics);

}  // namespace dtof
