// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dtof {

/// A section of a training map: candidates of the enlarger, and true distances.
struct MixingTruth {
  std::vector<float> distance_m;  ///< [pixel]; 0: not judged
  std::vector<float> candidates;  ///< [candidate][pixel], m
  std::vector<float> prior;       ///< [candidate][pixel] (enlarger_input.hpp)
};

/// Loss of a distance, 0 to 1: x / (x + 0.1), with x = sqrt(e^2 + 0.01^2) - 0.01 and e the relative error. So
/// errors of about 1 % and less count little, and an outlier counts about as much as a few pixels that are
/// some per cent off, as in shares of pixels.
double distance_loss(double measured_m, double true_m);

/// Summed loss of the judged pixels if softmax(scores + prior) mixes the candidates. `scores`:
/// [candidate][pixel]. `gradient` (same size) receives the derivatives.
double mixing_loss(std::span<const float> scores, const MixingTruth& truth, std::span<float> gradient);

/// Number of judged pixels.
std::size_t judged_pixels(const MixingTruth& truth);

}  // namespace dtof
