// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dtof {

/// A cut-out of a training map: what the enlarger may mix, and what would be right.
struct MixingTruth {
  std::vector<float> distance_m;  ///< [pixel]; 0: not judged
  std::vector<float> candidates;  ///< [candidate][pixel], m
  std::vector<float> prior;       ///< [candidate][pixel] (enlarger_input.hpp)
};

/// How far off a distance is, from 0 to 1: x / (x + 0.1), where x is the size of the relative error, but for
/// errors of about 1 % and less, which count less: sqrt(error^2 + 0.01^2) - 0.01. An outlier thus counts
/// about as much as a few pixels that are some per cent off, as it does in shares of pixels.
double distance_loss(double measured_m, double true_m);

/// Sum of the loss of the pixels judged, when softmax(scores + prior) mixes the candidates. `scores`:
/// [candidate][pixel]; `gradient`, of the same size, gets its derivatives.
double mixing_loss(std::span<const float> scores, const MixingTruth& truth, std::span<float> gradient);

/// Pixels that are judged.
std::size_t judged_pixels(const MixingTruth& truth);

}  // namespace dtof
