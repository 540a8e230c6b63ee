// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace dtof {

/// What the expected error of a code depends on besides the code.
struct CodeConditions {
  double codes;   ///< codes of the range, T
  double sigma;   ///< standard deviation of the light's shortest feature, in codes
  double signal;  ///< events of the light in a frame, S
  double events;  ///< all events in a frame, N
};

/// Expected squared error, in codes, of a code of cosine and sine waves of some harmonics. powers[i] is
/// g[h]^2, the power of the light at harmonics[i]. Light at distance 0 differs from light at distance x, in
/// codes, by the counters' distance d:
///
///     d(x)^2 = 2 S^2  sum over the harmonics h of g[h]^2 (1 - cos(2 pi h x / T))
///
/// N events spread over the range give each counter the variance N / 2. The error is the bound of small
/// errors plus the wrong places, each with the probability that noise carries the counters more than half of
/// the way:
///
///     E = N / 2 / (S^2 sum of (2 pi h g[h] / T)^2)  +  sum over x of x^2 Q(d(x) / 2 / sqrt(N / 2))
///
/// x takes both signs, in steps of half a standard deviation, from two standard deviations on.
double expected_square_error(const CodeConditions& conditions, std::span<const int> harmonics,
                             std::span<const double> powers);

/// Replaces the harmonic whose replacement by another of 1 .. `largest` lowers `error` most, until no
/// replacement lowers it.
std::vector<int> best_replacements(std::vector<int> harmonics, int largest,
                                   const std::function<double(std::span<const int>)>& error);

}  // namespace dtof
