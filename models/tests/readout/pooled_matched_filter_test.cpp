// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/pooled_matched_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

std::vector<std::vector<double>> random_scores(CounterRandom& random, std::size_t rows, std::size_t bins) {
  std::vector<std::vector<double>> scores(rows, std::vector<double>(bins));
  for (std::vector<double>& row : scores) {
    for (double& score : row) {
      score = 10.0 * random.uniform();
    }
  }
  return scores;
}

// Every assignment of bins to pixels, straight from the header's sum.
std::vector<int> best_assignment(const std::vector<std::vector<double>>& scores, const PoolingPrior& prior) {
  const auto bins = static_cast<int>(scores.front().size());
  std::vector<int> bin(scores.size(), 0);
  std::vector<int> best = bin;
  double largest = -std::numeric_limits<double>::infinity();
  for (bool more = true; more;) {
    double sum = 0.0;
    for (std::size_t row = 0; row < bin.size(); ++row) {
      sum += scores[row][static_cast<std::size_t>(bin[row])];
      if (row > 0 && std::abs(bin[row] - bin[row - 1]) > prior.reach_bins) {
        sum -= prior.edge_penalty;
      }
    }
    if (sum > largest) {
      largest = sum;
      best = bin;
    }
    more = false;
    for (int& digit : bin) {
      digit = (digit + 1) % bins;
      if (digit != 0) {
        more = true;
        break;
      }
    }
  }
  return best;
}

TEST(PooledMatchedFilter, MaximumOfAllAssignments) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 3, 0);
  for (int i = 0; i < 60; ++i) {
    const PoolingPrior prior{.reach_bins = i % 3, .edge_penalty = 6.0 * random.uniform()};
    const auto scores = random_scores(random, 1 + static_cast<std::size_t>(i % 5), 7);
    const std::vector<int> expected = best_assignment(scores, prior);
    const std::vector<MatchedFilter::Result> results = pool_column(scores, prior);
    ASSERT_EQ(results.size(), scores.size());
    for (std::size_t row = 0; row < scores.size(); ++row) {
      const auto bin = static_cast<std::size_t>(expected[row]);
      EXPECT_EQ(results[row].position, refined_peak(scores[row], bin)) << "column " << i << ", row " << row;
      EXPECT_GE(results[row].score, 0.0);
    }
  }
}

TEST(PooledMatchedFilter, WithoutAPenaltyEveryPixelIsOnItsOwn) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 4, 0);
  const auto scores = random_scores(random, 20, 100);
  const std::vector<MatchedFilter::Result> results =
      pool_column(scores, {.reach_bins = 3, .edge_penalty = 0.0});
  for (std::size_t row = 0; row < scores.size(); ++row) {
    const auto best = std::ranges::max_element(scores[row]) - scores[row].begin();
    EXPECT_EQ(results[row].position, refined_peak(scores[row], static_cast<std::size_t>(best)));
  }
}

TEST(PooledMatchedFilter, NeighboursOutvoteANoisePeakButNotASurePixel) {
  // Three pixels see a pulse at bin 20; the middle one has more at bin 80.
  std::vector<std::vector<double>> scores(3, std::vector<double>(100, 0.0));
  for (std::vector<double>& row : scores) {
    row[20] = 5.0;
  }
  scores[1][80] = 7.0;
  const PoolingPrior prior{.reach_bins = 4, .edge_penalty = 3.0};
  EXPECT_EQ(pool_column(scores, prior)[1].position, 20.0);
  EXPECT_EQ(pool_column(scores, prior)[1].score, 4.0);  // 5 + 0 + 0 against 7 - 3 - 3
  scores[1][80] = 12.0;
  EXPECT_EQ(pool_column(scores, prior)[1].position, 80.0);
}

TEST(PooledMatchedFilter, Refusals) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  const std::vector<std::vector<double>> uneven = {{1.0, 2.0}, {1.0}};
  EXPECT_THAT([&] { pool_column(uneven); }, ThrowsMessage<InputError>(HasSubstr("pixel 1 has 1 scores")));
  const std::vector<std::vector<double>> nothing = {{}, {1.0}};
  EXPECT_THAT([&] { pool_column(nothing); }, ThrowsMessage<InputError>(HasSubstr("pixel 0 has 0 scores")));
  const std::vector<std::vector<double>> one = {{1.0, 2.0}};
  EXPECT_THAT([&] { pool_column(one, {.reach_bins = -1}); }, ThrowsMessage<InputError>(HasSubstr("reach")));
  EXPECT_THAT([&] { pool_column(one, {.edge_penalty = NAN}); },
              ThrowsMessage<InputError>(HasSubstr("penalty")));
  EXPECT_TRUE(pool_column({}).empty());
}

}  // namespace
}  // namespace dtof
