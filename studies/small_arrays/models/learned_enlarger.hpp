// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "small_arrays/models/enlarger.hpp"
#include "small_arrays/models/enlarger_input.hpp"

namespace dtof {

/// 3 x 3 convolution; beyond the border are zeros.
struct Convolution {
  int inputs = 0;
  int outputs = 0;
  std::vector<float> weights;  ///< [output][input][row][column]
  std::vector<float> biases;   ///< [output]
};

/// A small convolutional network looks at each pixel's features (enlarger_input.hpp). What it says of a
/// candidate is added to the logarithm of that one's weight in a joint bilateral filter; the weights, at
/// least 0 and together 1, follow from the sums; the pixel's distance is their weighted mean. It can thus
/// choose a side of an edge, but not invent a distance.
struct EnlargerWeights {
  JointBilateral joint_bilateral;   ///< chosen on the same training maps
  std::vector<Convolution> layers;  ///< max(0, x) between them; the last one has an output a candidate
};

/// Text: a line "dtof-enlarger 1", "joint_bilateral SPATIAL RANGE", then of each layer "convolution INPUTS
/// OUTPUTS", its biases and its weights; lines that begin with # are comments. Throws InputError with `name`
/// and line for anything else, also for layers that do not fit together.
EnlargerWeights parse_enlarger_weights(std::string_view text, std::string_view name);
/// The same with numbers of five digits; `comment` may have several lines.
std::string write_enlarger_weights(const EnlargerWeights& weights, std::string_view comment);

/// Those of enlarge/weights.txt, which `make train-enlarger` found.
EnlargerWeights trained_weights();
/// Its text, compiled in.
std::string trained_weights_text();

/// The last layer's outputs and the prior, [candidate][row][column]: logarithms of the weights but for a
/// constant.
std::vector<float> enlarger_scores(const EnlargerWeights& weights, const EnlargerInput& input);
/// The distances that the scores mix, m.
std::vector<double> mix_candidates(const EnlargerInput& input, const std::vector<float>& scores);

/// As the enlargers of enlarger.hpp.
std::vector<double> enlarge_learned(const SmallMap& map, const IntensityImage& image,
                                    const EnlargerWeights& weights);

}  // namespace dtof
