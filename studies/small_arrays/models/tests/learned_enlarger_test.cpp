// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/models/learned_enlarger.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::StrEq;
using testing::ThrowsMessage;

EnlargerWeights random_weights(const std::vector<int>& channels) {
  std::minstd_rand random(5);
  std::uniform_real_distribution<float> draw(-0.3F, 0.3F);
  EnlargerWeights weights;
  int inputs = kFeatures;
  for (const int outputs : channels) {
    Convolution layer{inputs, outputs, {}, {}};
    std::generate_n(std::back_inserter(layer.weights), inputs * outputs * 9, [&] { return draw(random); });
    std::generate_n(std::back_inserter(layer.biases), outputs, [&] { return draw(random); });
    weights.layers.push_back(std::move(layer));
    inputs = outputs;
  }
  return weights;
}

EnlargerInput random_input(int columns, int rows) {
  std::minstd_rand random(6);
  std::uniform_real_distribution<float> draw(-1.0F, 2.0F);
  EnlargerInput input{columns, rows, {}, {}, {}};
  std::generate_n(std::back_inserter(input.features), kFeatures * input.pixels(),
                  [&] { return draw(random); });
  std::generate_n(std::back_inserter(input.candidates), kCandidates * input.pixels(),
                  [&] { return 1.0F + std::abs(draw(random)); });
  std::generate_n(std::back_inserter(input.prior), kCandidates * input.pixels(),
                  [&] { return draw(random); });
  return input;
}

/// An output by the definition: the network's are asked for one by one, from the last layer down.
double slow_output(const EnlargerWeights& weights, const EnlargerInput& input, std::size_t layers, int output,
                   int column, int row) {
  if (column < 0 || row < 0 || column >= input.columns || row >= input.rows) {
    return 0.0;
  }
  if (layers == 0) {
    return input.features.at(static_cast<std::size_t>((output * input.rows + row) * input.columns + column));
  }
  const Convolution& layer = weights.layers.at(layers - 1);
  double sum = layer.biases.at(static_cast<std::size_t>(output));
  for (int i = 0; i < layer.inputs; ++i) {
    for (int tap = 0; tap < 9; ++tap) {
      double value = slow_output(weights, input, layers - 1, i, column + tap % 3 - 1, row + tap / 3 - 1);
      if (layers > 1) {
        value = std::max(0.0, value);
      }
      sum += layer.weights.at(static_cast<std::size_t>((output * layer.inputs + i) * 9 + tap)) * value;
    }
  }
  return sum;
}

TEST(LearnedEnlarger, ScoresAreThoseOfTheDefinition) {
  const EnlargerInput input = random_input(7, 5);
  for (const std::vector<int>& channels : {std::vector<int>{kCandidates}, {4, kCandidates}}) {
    const EnlargerWeights weights = random_weights(channels);
    const std::vector<float> scores = enlarger_scores(weights, input);
    ASSERT_EQ(scores.size(), kCandidates * input.pixels());
    for (int k = 0; k < kCandidates; ++k) {
      for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 7; ++column) {
          const auto i = static_cast<std::size_t>((k * 5 + row) * 7 + column);
          EXPECT_NEAR(scores[i],
                      input.prior[i] + slow_output(weights, input, channels.size(), k, column, row), 1e-4)
              << k << ": " << column << ", " << row;
        }
      }
    }
  }
}

TEST(LearnedEnlarger, TheTrainedWeightsScoresAreThoseOfTheDefinition) {
  const EnlargerInput input = random_input(3, 2);
  const EnlargerWeights weights = trained_weights();
  const std::vector<float> scores = enlarger_scores(weights, input);
  EXPECT_NEAR(scores.at(0) - input.prior.at(0), slow_output(weights, input, weights.layers.size(), 0, 0, 0),
              1e-3);
  EXPECT_NEAR(scores.at(8 * 6 + 4) - input.prior.at(8 * 6 + 4),
              slow_output(weights, input, weights.layers.size(), 8, 1, 1), 1e-3);
}

TEST(LearnedEnlarger, ScoresMixCandidatesBySoftmax) {
  EnlargerInput input{2, 1, {}, {}, {}};
  std::vector<float> scores(18);
  for (int k = 0; k < 9; ++k) {
    input.candidates.push_back(1.0F + static_cast<float>(k));
    input.candidates.push_back(1.0F + static_cast<float>(k));
  }
  scores[2 * 3] = 1000.0F;  // pixel 0 takes candidate 3 alone; pixel 1 mixes 0 and 8, 3 to 1
  for (std::size_t k = 0; k < 9; ++k) {
    scores[2 * k + 1] = -1000.0F;
  }
  scores[1] = std::log(3.0F);
  scores[2 * 8 + 1] = 0.0F;
  const std::vector<double> mixed = mix_candidates(input, scores);
  EXPECT_NEAR(mixed.at(0), 4.0, 1e-9);
  EXPECT_NEAR(mixed.at(1), 0.75 * 1.0 + 0.25 * 9.0, 1e-6);
}

TEST(LearnedEnlarger, AMapOfOneDistanceStaysIt) {
  const SpotGrid grid = make_spot_grid(20, 16, 8, 5);
  const SmallMap map{grid, std::vector<double>(40, 2.5), std::vector<double>(40, 1.0)};
  const std::vector<double> large =
      enlarge_learned(map, {20, 16, std::vector<double>(320, 3.0)}, trained_weights());
  EXPECT_THAT(large, testing::Each(testing::DoubleNear(2.5, 1e-9)));
}

TEST(LearnedEnlarger, TrainedWeightsFollowAnEdgeThatTheImageShows) {
  const SpotGrid grid = make_spot_grid(40, 40, 20, 20);  // spots at odd columns
  SmallMap map{grid, {}, {}};
  IntensityImage image{40, 40, {}};
  for (int i = 0; i < 400; ++i) {
    map.distance_m.push_back(i % 20 < 10 ? 2.0 : 4.0);  // from spot 9 at column 19 to spot 10 at column 21
    map.confidence.push_back(1.0 + i % 7);
  }
  double nearest = 0.0;
  double learned = 0.0;
  for (const int edge : {20, 21}) {
    image.values.clear();
    for (int i = 0; i < 1600; ++i) {
      image.values.push_back(i % 40 < edge ? 800.0 : 200.0);
    }
    const auto error = [&](const std::vector<double>& large) {
      double sum = 0.0;
      for (int i = 0; i < 1600; ++i) {
        sum += std::abs(large[static_cast<std::size_t>(i)] - (i % 40 < edge ? 2.0 : 4.0));
      }
      return sum;
    };
    nearest += error(enlarge_nearest(map));
    learned += error(enlarge_learned(map, image, trained_weights()));
  }
  EXPECT_LT(learned, 0.5 * nearest);
}

TEST(EnlargerWeights, AreReadAsWritten) {
  EnlargerWeights weights = random_weights({2, kCandidates});
  weights.joint_bilateral = {0.25, 0.045};
  const std::string text = write_enlarger_weights(weights, "first\nsecond");
  EXPECT_THAT(text, testing::StartsWith("# first\n# second\ndtof-enlarger 1\njoint_bilateral 0.25 0.045\n"));
  const EnlargerWeights back = parse_enlarger_weights(text, "w");
  EXPECT_EQ(back.joint_bilateral.spatial, 0.25);
  EXPECT_EQ(back.joint_bilateral.range, 0.045);
  ASSERT_EQ(back.layers.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.layers[i].inputs, weights.layers[i].inputs);
    EXPECT_EQ(back.layers[i].outputs, weights.layers[i].outputs);
    EXPECT_THAT(back.layers[i].weights,
                testing::Pointwise(testing::FloatNear(1e-5F), weights.layers[i].weights));
    EXPECT_THAT(back.layers[i].biases,
                testing::Pointwise(testing::FloatNear(1e-5F), weights.layers[i].biases));
  }
  EXPECT_EQ(write_enlarger_weights(back, "first\nsecond"), text);
}

TEST(EnlargerWeights, AnErrorIsOneLineThatSaysWhere) {
  const std::string head = "# made up\ndtof-enlarger 1\njoint_bilateral 0.5 0.1\n";
  const auto layer = [](int inputs, int outputs) {
    std::string text = fmt::format("convolution {} {}\n", inputs, outputs);
    for (int i = 0; i < outputs * (1 + 9 * inputs); ++i) {
      text += "0.5\n";
    }
    return text;
  };
  const auto refused = [](const std::string& text, const std::string& message) {
    EXPECT_THAT([&] { (void)parse_enlarger_weights(text, "w.txt"); },
                ThrowsMessage<InputError>(StrEq(message)));
  };
  refused("", "w.txt, line 1: the file ends, dtof-enlarger is missing");
  refused("# made up\nP5 1 1\n", "w.txt, line 2: expected 'dtof-enlarger', found 'P5'");
  refused("dtof-enlarger 2", "w.txt, line 1: version 2 is not 1");
  refused("dtof-enlarger 1.5", "w.txt, line 1: the version is '1.5', which is no number that can be used");
  refused("dtof-enlarger 1\njoint_bilateral 0.5",
          "w.txt, line 2: the file ends, a width of the joint bilateral filter is missing");
  refused("dtof-enlarger 1\njoint_bilateral 0.5 -1",
          "w.txt, line 2: a width of the joint bilateral filter is -1, not above 0");
  refused(head, "w.txt, line 3: there is no layer");
  refused(head + "convolution 30 9\n",
          "w.txt, line 4: a layer of 30 inputs and 9 outputs cannot follow 31 channels");
  refused(head + "convolution 31 1000000000\n",
          "w.txt, line 4: a layer of 31 inputs and 1000000000 outputs cannot follow 31 channels");
  refused(head + layer(kFeatures, 4) + layer(5, 9),
          fmt::format("w.txt, line {}: a layer of 5 inputs and 9 outputs cannot follow 4 channels",
                      5 + 4 * (1 + 9 * kFeatures)));
  refused(head + layer(kFeatures, 4),
          fmt::format("w.txt, line {}: the last layer has 4 outputs, not 9", 4 + 4 * (1 + 9 * kFeatures)));
  refused(head + "convolution 31 1\n0.5\n0.25 nan\n",
          "w.txt, line 6: a weight is 'nan', which is no number that can be used");
  refused(head + "convolution 31 1\n0.5\n0.25 1e99\n",
          "w.txt, line 6: a weight is '1e99', which is no number that can be used");
  refused(head + "convolution 31 1\n0.5\n0.25 0.5x\n",
          "w.txt, line 6: a weight is '0.5x', which is no number that can be used");
  refused(head + "convolution 31 1\n0.5\n0.25", "w.txt, line 6: the file ends, a weight is missing");
  refused(head + layer(kFeatures, kCandidates) + "0.5\n",
          fmt::format("w.txt, line {}: expected 'convolution', found '0.5'", 5 + 9 * (1 + 9 * kFeatures)));
}

}  // namespace
}  // namespace dtof
