// SPDX-License-Identifier: Apache-2.0
#include <dlib/dnn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include "small_arrays/models/learned_enlarger.hpp"

namespace dtof {
namespace {

/// One convolution by dlib alone.
dlib::resizable_tensor convolve(const Convolution& convolution, const dlib::tensor& input) {
  dlib::resizable_tensor filters(convolution.outputs, convolution.inputs, 3, 3);
  std::ranges::copy(convolution.weights, filters.host());
  dlib::resizable_tensor biases(1, convolution.outputs);
  std::ranges::copy(convolution.biases, biases.host());
  dlib::tt::tensor_conv by_dlib;
  by_dlib.setup(input, filters, 1, 1, 1, 1);
  dlib::resizable_tensor output;
  by_dlib(false, output, input, filters);
  dlib::tt::add(1, output, 1, biases);
  return output;
}

TEST(DlibNetwork, GivesTheScoresOfThePlainInference) {
  const EnlargerWeights weights = trained_weights();
  EnlargerInput input{23, 17, {}, {}, std::vector<float>(kCandidates * 23 * 17)};
  std::minstd_rand random(11);
  std::uniform_real_distribution<float> draw(-1.0F, 1.0F);
  for (std::size_t i = 0; i < kFeatures * input.pixels(); ++i) {
    input.features.push_back(draw(random));
  }
  dlib::resizable_tensor values(1, kFeatures, input.rows, input.columns);
  std::ranges::copy(input.features, values.host());
  for (std::size_t i = 0; i < weights.layers.size(); ++i) {
    if (i > 0) {
      dlib::tt::relu(values, values);
    }
    values = convolve(weights.layers[i], values);
  }
  const std::vector<float> theirs(values.host(), values.host() + values.size());
  EXPECT_THAT(enlarger_scores(weights, input), testing::Pointwise(testing::FloatNear(1e-3F), theirs));
  EXPECT_GT(*std::ranges::max_element(theirs), *std::ranges::min_element(theirs) + 1.0F);
}

}  // namespace
}  // namespace dtof
