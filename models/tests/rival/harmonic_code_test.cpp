// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/harmonic_code.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <span>
#include <vector>

namespace dtof {
namespace {

using testing::ElementsAre;

// Few photons, harmonic 1 alone, T = 8, sigma = 2: the only wrong place is x = 4, half a range away. There
// d^2 = 2 S^2 g^2 (1 - cos(pi)) = 4 S^2 g^2.
TEST(HarmonicCode, ExpectedErrorIsTheBoundAndTheWrongPlaces) {
  const CodeConditions conditions{.codes = 8.0, .sigma = 2.0, .signal = 3.0, .events = 18.0};
  const double power = 0.25;
  const double slope = 3.0 * 0.5 * 2.0 * std::numbers::pi / 8.0;
  const double bound = 9.0 / (slope * slope);
  const double sigmas = 0.5 * (2.0 * 3.0 * 0.5) / 3.0;  // half of the way over sqrt(N / 2)
  const double wrong = 16.0 * 2.0 * (0.5 * std::erfc(sigmas / std::numbers::sqrt2));
  EXPECT_NEAR(expected_square_error(conditions, std::vector{1}, std::vector{power}), bound + wrong, 1e-12);
}

// The cheapest pair of 1 .. 9 is (3, 7); the largest replacement allowed bounds the search.
TEST(HarmonicCode, ReplacementsEndAtTheLeastError) {
  const auto error = [](std::span<const int> pair) {
    return std::abs(pair[0] - 3) + std::abs(pair[1] - 7) + 0.0;
  };
  EXPECT_THAT(best_replacements({1, 2}, 9, error), ElementsAre(3, 7));
  EXPECT_THAT(best_replacements({1, 2}, 5, error), ElementsAre(3, 5));
  EXPECT_THAT(best_replacements({3, 7}, 9, error), ElementsAre(3, 7));
}

// Equal errors replace nothing, so the search ends; no harmonic is used twice.
TEST(HarmonicCode, EqualErrorsReplaceNothing) {
  EXPECT_THAT(best_replacements({4, 2}, 9, [](std::span<const int>) { return 1.0; }), ElementsAre(4, 2));
  const auto both_want_three = [](std::span<const int> pair) {
    return std::abs(pair[0] - 3) + std::abs(pair[1] - 3) + 0.0;
  };
  EXPECT_THAT(best_replacements({1, 9}, 9, both_want_three),
              testing::UnorderedElementsAre(3, testing::AnyOf(2, 4)));
}

}  // namespace
}  // namespace dtof
