// SPDX-License-Identifier: Apache-2.0
#include "small_arrays/trainer/mixing_loss.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <random>
#include <vector>

#include "small_arrays/models/enlarger_input.hpp"
#include "small_arrays/models/learned_enlarger.hpp"

namespace dtof {
namespace {

struct Example {
  std::vector<float> scores;
  MixingTruth truth;
};

/// Six pixels, of which the third one is not judged.
Example make_example() {
  std::minstd_rand random(9);
  std::uniform_real_distribution<float> score(-2.0F, 2.0F);
  std::uniform_real_distribution<float> distance(1.0F, 4.0F);
  Example example;
  std::generate_n(std::back_inserter(example.scores), 6 * kCandidates, [&] { return score(random); });
  std::generate_n(std::back_inserter(example.truth.candidates), 6 * kCandidates,
                  [&] { return distance(random); });
  std::generate_n(std::back_inserter(example.truth.prior), 6 * kCandidates, [&] { return score(random); });
  std::generate_n(std::back_inserter(example.truth.distance_m), 6, [&] { return distance(random); });
  example.truth.distance_m[2] = 0.0F;
  return example;
}

TEST(MixingLoss, OfADistanceIsZeroAtTheTruthAndAtMostOne) {
  EXPECT_EQ(distance_loss(2.0, 2.0), 0.0);
  const double half = std::sqrt(0.5 * 0.5 + 0.01 * 0.01) - 0.01;
  EXPECT_NEAR(distance_loss(3.0, 2.0), half / (half + 0.1), 1e-12);
  EXPECT_NEAR(distance_loss(1.0, 2.0), half / (half + 0.1), 1e-12);
  const double small = 0.01 * (std::sqrt(2.0) - 1.0);
  EXPECT_NEAR(distance_loss(2.02, 2.0), small / (small + 0.1), 1e-12);
  EXPECT_LT(distance_loss(1e6, 2.0), 1.0);
}

TEST(MixingLoss, IsThatOfTheDistancesTheEnlargerMixes) {
  const Example example = make_example();
  std::vector<float> sums = example.scores;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] += example.truth.prior[i];
  }
  const std::vector<double> mixed = mix_candidates({6, 1, {}, example.truth.candidates, {}}, sums);
  double expected = 0.0;
  for (const std::size_t pixel : {0, 1, 3, 4, 5}) {
    expected += distance_loss(mixed[pixel], example.truth.distance_m[pixel]);
  }
  std::vector<float> gradient(example.scores.size());
  EXPECT_NEAR(mixing_loss(example.scores, example.truth, gradient), expected, 1e-5);
  EXPECT_EQ(judged_pixels(example.truth), 5U);
}

TEST(MixingLoss, GradientIsThatOfFiniteDifferences) {
  Example example = make_example();
  std::vector<float> gradient(example.scores.size(), 7.0F);  // what was there before does not stay
  (void)mixing_loss(example.scores, example.truth, gradient);
  std::vector<float> ignored(example.scores.size());
  constexpr float kStep = 0.01F;
  double largest = 0.0;
  for (std::size_t i = 0; i < example.scores.size(); ++i) {
    const float score = example.scores[i];
    example.scores[i] = score + kStep;
    const double above = mixing_loss(example.scores, example.truth, ignored);
    example.scores[i] = score - kStep;
    const double below = mixing_loss(example.scores, example.truth, ignored);
    example.scores[i] = score;
    EXPECT_NEAR(gradient[i], (above - below) / (2.0 * kStep), 1e-4) << i;
    largest = std::max(largest, std::abs(double{gradient[i]}));
    if (i % 6 == 2) {
      EXPECT_EQ(gradient[i], 0.0F) << i;
    }
  }
  EXPECT_GT(largest, 0.02);
}

}  // namespace
}  // namespace dtof
