// SPDX-License-Identifier: Apache-2.0
#include "rivals/paper_claims.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/rival/coarse_histogram.hpp"
#include "dtof/rival/legendre_memory.hpp"
#include "dtof/rival/linear_code.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

PaperClaims small_run(int threads) {
  return judge_paper_claims({.pixels = 200, .seed = 3, .threads = threads});
}

const PaperClaims& on_all_threads() {
  static const PaperClaims found = small_run(0);
  return found;
}

TEST(IndependentPhotons, AreThoseOfTheirEquation) {
  const IndependentPhotons photons{.np = 10, .pulse_sigma = 0.02, .detections = 4000, .signal_share = 0.25};
  // The mean of all timestamps is that of the mixture, and their share around the place is the pulse's and
  // the background's there.
  const PlaceEstimator mean = [](PixelFrames frames) {
    double sum = 0.0;
    for (const Detection& detection : frames.back()) {
      sum += detection.timestamp;
    }
    return sum / static_cast<double>(frames.back().size());
  };
  const PlaceErrors found = place_errors(photons, {mean}, 100, 1, 0);
  double off = 0.0;
  for (std::size_t pixel = 0; pixel < 100; ++pixel) {
    const double expected = 0.25 * found.places[pixel] + 0.75 * 511.5;
    off += (found.errors[0][pixel] + found.places[pixel] - expected) / 100.0;
    EXPECT_GT(found.places[pixel], 100.0);
    EXPECT_LT(found.places[pixel], 923.0);
  }
  EXPECT_NEAR(off, 0.0, 4.0 * 300.0 / std::sqrt(4000.0 * 100.0));
}

TEST(IndependentPhotons, FullHistogramReachesTheCramerRaoBound) {
  for (const double share : {0.5, 0.1}) {
    const IndependentPhotons photons{
        .np = 10, .pulse_sigma = 0.02, .detections = 4000, .signal_share = share};
    const PlaceErrors found = place_errors(
        photons, {estimator_of(make_coarse_histogram(photons.sensor(), {.bin_bits = 10, .count_bits = 12}))},
        400, 1, 0);
    const Estimate error = estimate_root_mean_square(found.errors[0]);
    EXPECT_LT(error.interval.low, 1.1 * photons.cramer_rao_bound()) << share;
    EXPECT_GT(error.interval.high, 0.98 * photons.cramer_rao_bound()) << share;
  }
}

// Two triangular waves of height 7 have the slope 28 per range each; where one turns, the other tells the
// place alone. The mean over 2^s detections keeps the noise of 2^(s + 1).
TEST(IndependentPhotons, CorrelationsAreAsExactAsTheirClosedForm) {
  constexpr int kShift = 12;
  const IndependentPhotons photons{
      .np = 10, .pulse_sigma = 0.02, .detections = 4U << kShift, .signal_share = 0.05};
  const PlaceErrors found =
      place_errors(photons, {estimator_of(make_two_correlations(photons.sensor(), kShift))}, 300, 1, 0);
  const double noise = 7.0 / std::numbers::sqrt3 / std::sqrt(std::ldexp(1.0, kShift + 1));
  const double worst = noise / (28.0 * photons.signal_share) * 1024.0;
  const Estimate precision = estimate_standard_deviation(found.errors[0]);
  EXPECT_LT(precision.interval.low, worst);
  EXPECT_GT(precision.interval.high, worst / std::numbers::sqrt2);
  EXPECT_LT(precision.value, 1.1 * worst);
  EXPECT_GT(precision.value, 0.9 * worst / std::numbers::sqrt2);
}

TEST(IndependentPhotons, RefusesWhatIsNoShare) {
  EXPECT_THAT([] { place_errors({.signal_share = 1.5}, {}, 1, 1, 1); },
              ThrowsMessage<InputError>(HasSubstr("signal's share must be 0 to 1, not 1.5")));
  EXPECT_THAT([] { place_errors({.pulse_sigma = 0.2}, {}, 1, 1, 1); },
              ThrowsMessage<InputError>(HasSubstr("standard deviation must be above 0 and below 0.1")));
}

TEST(PaperClaims, EachHasAFigureAndAVerdict) {
  const PaperClaims& found = on_all_threads();
  ASSERT_EQ(found.scenes.size(), 4U);
  for (const PaperScene& scene : found.scenes) {
    const double ratio = scene.code("full histogram, matched filter").rmse.value / scene.bound;
    EXPECT_GT(ratio, 0.8) << scene.name;
    EXPECT_LT(ratio, 1.3) << scene.name;
  }
  EXPECT_EQ(found.claims.size(), 20U);
  for (const PaperClaim& claim : found.claims) {
    for (const std::string& text : {claim.paper, claim.claim, claim.test, claim.figure}) {
      EXPECT_FALSE(text.empty());
    }
  }
  const auto verdict = [&](std::string_view beginning) {
    const auto claim = std::ranges::find_if(
        found.claims, [&](const PaperClaim& one) { return one.claim.starts_with(beginning); });
    return claim == found.claims.end() ? ClaimVerdict::kFails : claim->verdict;
  };
  EXPECT_EQ(verdict("Compression up to 150"), ClaimVerdict::kHolds);
  EXPECT_EQ(verdict("Coarse bins are not equally"), ClaimVerdict::kHolds);
  EXPECT_EQ(verdict("Equi-depth histograms tell more"), ClaimVerdict::kHolds);
  EXPECT_EQ(verdict("Precision below one centimetre"), ClaimVerdict::kHolds);
  EXPECT_EQ(verdict("An average of timestamps"), ClaimVerdict::kHolds);
  EXPECT_EQ(verdict("A spiking network"), ClaimVerdict::kInPart);
  EXPECT_NE(verdict("Codes that are optimised together"), ClaimVerdict::kFails);
}

TEST(PaperClaims, LargerSketchesAreMoreExact) {
  const PaperClaims& found = on_all_threads();
  const PaperScene& narrow = found.scenes[2];
  for (const auto& [larger, smaller] : {std::pair{"sketch M = 32", "sketch M = 8"},
                                        {"sketch M = 8", "sketch M = 2"},
                                        {"spline sketch m = 51", "spline sketch m = 16"},
                                        {"Legendre memory d = 32", "Legendre memory d = 16"},
                                        {"Legendre memory d = 16", "Legendre memory d = 8"},
                                        {"truncated Fourier K = 64", "truncated Fourier K = 16"}}) {
    EXPECT_LT(narrow.ratio(larger, smaller), 0.7) << larger;
  }
  EXPECT_THROW((void)narrow.code("no such code"), std::logic_error);
}

using Vector = std::vector<double>;
using Matrix = std::vector<Vector>;

/// x with a x = b, by elimination without exchange of rows: `a` is positive definite.
Vector solved(Matrix a, Vector b) {
  const std::size_t size = b.size();
  for (std::size_t pivot = 0; pivot < size; ++pivot) {
    for (std::size_t row = 0; row < size; ++row) {
      const double factor = row == pivot ? 0.0 : a[row][pivot] / a[pivot][pivot];
      for (std::size_t column = pivot; column < size && factor != 0.0; ++column) {
        a[row][column] -= factor * a[pivot][column];
      }
      b[row] -= factor * b[pivot];
    }
  }
  for (std::size_t row = 0; row < size; ++row) {
    b[row] /= a[row][row];
  }
  return b;
}

/// Cramer-Rao bound of the place from a code's sums, whose noise is Gaussian if there are many detections.
/// The numbers of detections of the pulse and of the background are unknown.
double bound_of_sums(const std::vector<std::int16_t>& weights, std::size_t counters,
                     const IndependentPhotons& photons, double place) {
  const auto codes = static_cast<std::size_t>(std::ldexp(1.0, photons.np));
  const double sigma = photons.pulse_sigma * static_cast<double>(codes);
  const double signal = photons.signal_share * photons.detections;
  const double background = (photons.detections - signal) / static_cast<double>(codes);
  Matrix slopes(3, Vector(counters, 0.0));  // of the means, by place, signal and background
  Matrix covariance(counters, Vector(counters, 0.0));
  for (std::size_t x = 0; x < codes; ++x) {
    const double z = (static_cast<double>(x) - place) / sigma;
    const double share = std::exp(-0.5 * z * z) / (sigma * std::sqrt(2.0 * std::numbers::pi));
    for (std::size_t k = 0; k < counters; ++k) {
      const double weight = weights[x * counters + k];
      slopes[0][k] += signal * share * z / sigma * weight;
      slopes[1][k] += share * weight;
      slopes[2][k] += weight;
      for (std::size_t j = 0; j < counters; ++j) {
        covariance[k][j] += (signal * share + background) * weight * weights[x * counters + j];
      }
    }
  }
  Matrix information(3, Vector(3, 0.0));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector whitened = solved(covariance, slopes[i]);
    for (std::size_t j = 0; j < 3; ++j) {
      information[i][j] = std::inner_product(whitened.begin(), whitened.end(), slopes[j].begin(), 0.0);
    }
  }
  return std::sqrt(solved(information, {1.0, 0.0, 0.0})[0]);
}

// So the matched filter stands for the best that can be done with the numbers of a Legendre memory.
TEST(PaperClaims, LegendreMemoriesAreReadAsWellAsTheirBoundAllows) {
  constexpr int kPlaces = 12;
  for (const std::size_t scene : {0U, 1U}) {
    const PaperScene& photons = on_all_threads().scenes[scene];
    for (const int order : {8, 16}) {
      const std::vector<std::int16_t> weights = legendre_weights(10, order, 4);
      double squares = 0.0;
      for (int i = 0; i < kPlaces; ++i) {
        const double bound = bound_of_sums(weights, static_cast<std::size_t>(order), photons.photons,
                                           100.0 + 823.0 * (i + 0.5) / kPlaces);
        squares += bound * bound / kPlaces;
      }
      const Estimate error = photons.code(fmt::format("Legendre memory d = {}", order)).rmse;
      EXPECT_LT(error.interval.low, 1.1 * std::sqrt(squares)) << photons.name << " " << order;
      EXPECT_GT(error.interval.high, 0.95 * std::sqrt(squares)) << photons.name << " " << order;
    }
  }
}

TEST(PaperClaims, DoNotDependOnTheThreads) {
  const PaperClaims& one = on_all_threads();
  const PaperClaims three = small_run(hardware_threads() + 1);
  for (std::size_t i = 0; i < one.claims.size(); ++i) {
    EXPECT_EQ(one.claims[i].figure, three.claims[i].figure);
    EXPECT_EQ(one.claims[i].verdict, three.claims[i].verdict);
  }
}

TEST(PaperClaims, RefusesTooFewPixels) {
  EXPECT_THAT([] { judge_paper_claims({.pixels = 99}); },
              ThrowsMessage<InputError>(HasSubstr("99 pixels, but it must be at least 100")));
}

}  // namespace
}  // namespace dtof
