// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/harmonic_code.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace dtof {

double expected_square_error(const CodeConditions& conditions, std::span<const int> harmonics,
                             std::span<const double> powers) {
  const double turn = 2.0 * std::numbers::pi / conditions.codes;
  const double noise = std::sqrt(0.5 * conditions.events);
  double slope = 0.0;
  for (std::size_t i = 0; i < harmonics.size(); ++i) {
    slope += powers[i] * (turn * harmonics[i]) * (turn * harmonics[i]);
  }
  double sum = 0.5 * conditions.events / (conditions.signal * conditions.signal * slope);
  for (double x = 2.0 * conditions.sigma; x <= 0.5 * conditions.codes; x += 0.5 * conditions.sigma) {
    double square = 0.0;
    for (std::size_t i = 0; i < harmonics.size(); ++i) {
      square += 2.0 * powers[i] * (1.0 - std::cos(turn * harmonics[i] * x));
    }
    const double half_way = 0.5 * conditions.signal * std::sqrt(square) / noise;
    sum += x * x * std::erfc(half_way / std::numbers::sqrt2);  // both signs: 2 Q
  }
  return sum;
}

std::vector<int> best_replacements(std::vector<int> harmonics, int largest,
                                   const std::function<double(std::span<const int>)>& error) {
  double least = error(harmonics);
  for (bool better = true; better;) {
    better = false;
    const std::vector<int> from = harmonics;
    for (std::size_t place = 0; place < from.size(); ++place) {
      for (int harmonic = 1; harmonic <= largest; ++harmonic) {
        if (std::ranges::count(from, harmonic) > 0) {
          continue;
        }
        std::vector<int> tried = from;
        tried[place] = harmonic;
        if (const double found = error(tried); found < least) {
          least = found;
          harmonics = tried;
          better = true;
        }
      }
    }
  }
  return harmonics;
}

}  // namespace dtof
