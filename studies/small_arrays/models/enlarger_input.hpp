// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "small_arrays/models/enlarger.hpp"

namespace dtof {

/// Number of candidates whose distances a pixel of the large array mixes: the 3 x 3 spots around the nearest
/// one, row by row. Beyond the border, the border's spots are repeated.
inline constexpr int kCandidates = 9;
/// Features of a pixel:
///  - 0 .. 8: logarithm of each candidate's distance relative to the candidates' median, times 5, limited to
///    -2 .. 2;
///  - 9 .. 17: each candidate's confidence, as the share of the small array's pixels with less confidence;
///  - 18 .. 26: similarity of each candidate's brightness to the pixel's: exp(-(difference / 0.05)^2 / 2);
///  - 27: the pixel's brightness;
///  - 28, 29: offset of the pixel to the right of and below the nearest spot, in the spots' mean spacing;
///  - 30: the spots' mean spacing in pixels, divided by 4.
inline constexpr int kFeatures = 3 * kCandidates + 4;

/// Input of the learned enlarger, for each pixel of the large array.
struct EnlargerInput {
  int columns = 0;
  int rows = 0;
  std::vector<float> features;    ///< [feature][row][column]
  std::vector<float> candidates;  ///< distances in m, [candidate][row][column]
  /// Logarithm of the weight that a joint bilateral filter of widths 0.35 and 0.06 gives each candidate, at
  /// least -6 for the part by brightness. The network adds its own score. [candidate][row][column].
  std::vector<float> prior;

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

/// Throws InputError for sizes that do not match.
EnlargerInput make_enlarger_input(const SmallMap& map, const IntensityImage& image);

}  // namespace dtof
