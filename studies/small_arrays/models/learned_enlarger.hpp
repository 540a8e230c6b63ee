// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "small_arrays/models/enlarger.hpp"
#include "small_arrays/models/enlarger_input.hpp"

namespace dtof {

/// 3 x 3 convolution with zeros beyond the border.
struct Convolution {
  int inputs = 0;
  int outputs = 0;
  std::vector<float> weights;  ///< [output][input][row][column]
  std::vector<float> biases;   ///< [output]
};

/// A small convolutional network on each pixel's features (enlarger_input.hpp). Its output for a candidate is
/// added to the logarithm of that candidate's weight in a joint bilateral filter. The softmax of the sums
/// gives weights of at least 0 with sum 1; the pixel's distance is the weighted mean. So the network can
/// choose a side of an edge, but not invent a distance.
struct EnlargerWeights {
  JointBilateral joint_bilateral;  ///< chosen on the same training maps
  /// Max(0, x) follows each layer but the last, which has one output per candidate.
  std::vector<Convolution> layers;
};

/// Parses a text: a line "dtof-enlarger 1", a line "joint_bilateral SPATIAL RANGE", then for each layer
/// "convolution INPUTS OUTPUTS", its biases and its weights. Lines that begin with # are comments. Throws
/// InputError with `name` and line for anything else, also for layers that do not fit together.
EnlargerWeights parse_enlarger_weights(std::string_view text, std::string_view name);
/// Writes such a text with numbers of five digits; `comment` may have several lines.
std::string write_enlarger_weights(const EnlargerWeights& weights, std::string_view comment);

/// Weights in studies/small_arrays/models/weights.txt, a result of `make train-enlarger`.
EnlargerWeights trained_weights();
/// Text of these weights, compiled into the program.
std::string trained_weights_text();

/// Logarithms of the candidates' weights up to a constant: the last layer's outputs plus the prior,
/// [candidate][row][column].
std::vector<float> enlarger_scores(const EnlargerWeights& weights, const EnlargerInput& input);
/// Distances that result from mixing the candidates by the scores, m.
std::vector<double> mix_candidates(const EnlargerInput& input, const std::vector<float>& scores);

/// Enlarges a map with the network, with the interface of enlarger.hpp.
std::vector<double> enlarge_learned(const SmallMap& map, const IntensityImage& image,
                                    const EnlargerWeights& weights);

}  // namespace dtof
