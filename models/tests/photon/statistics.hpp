// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace dtof {

/// Below this p-value a statistical test fails: one false alarm in a million tests of a right model. A
/// sampled distribution that is wrong in a way a test is made for gives p-values of 1e-12 and less.
inline constexpr double kErrorRate = 1e-6;

/// Probability of a standard normal deviate at least this far from 0.
inline double normal_p(double deviation, double standard_deviation) {
  return std::erfc(std::abs(deviation) / standard_deviation / std::numbers::sqrt2);
}

/// Two-sided p-value of observed successes among `trials` of probability `p`.
inline double binomial_p(double successes, double trials, double p) {
  return normal_p(successes - trials * p, std::sqrt(trials * p * (1.0 - p)));
}

/// Pearson's chi-square p-value of counts of independent trials; `probability` need not sum to 1: the rest is
/// the outcome that is not counted. Neighbouring outcomes are pooled to at least 10 expected counts.
inline double chi_square_p(const std::vector<std::uint64_t>& counts, const std::vector<double>& probability,
                           double trials) {
  double chi_square = 0.0;
  double classes = 0.0;
  double expected = 0.0;
  double observed = 0.0;
  double expected_rest = trials;
  double observed_rest = trials;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    expected += trials * probability[i];
    observed += static_cast<double>(counts[i]);
    if (expected >= 10.0) {
      chi_square += (observed - expected) * (observed - expected) / expected;
      classes += 1.0;
      expected_rest -= expected;
      observed_rest -= observed;
      expected = observed = 0.0;
    }
  }
  if (expected_rest >= 10.0) {
    chi_square += (observed_rest - expected_rest) * (observed_rest - expected_rest) / expected_rest;
    classes += 1.0;
  }
  const boost::math::chi_squared_distribution<double> distribution(classes - 1.0);
  return boost::math::cdf(boost::math::complement(distribution, chi_square));
}

/// Pearson's chi-square p-value of independent Poisson counts with these means.
inline double poisson_chi_square_p(const std::vector<std::uint64_t>& counts,
                                   const std::vector<double>& means) {
  double chi_square = 0.0;
  double classes = 0.0;
  double expected = 0.0;
  double observed = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    expected += means[i];
    observed += static_cast<double>(counts[i]);
    if (expected >= 10.0) {
      chi_square += (observed - expected) * (observed - expected) / expected;
      classes += 1.0;
      expected = observed = 0.0;
    }
  }
  const boost::math::chi_squared_distribution<double> distribution(classes);
  return boost::math::cdf(boost::math::complement(distribution, chi_square));
}

/// Kolmogorov-Smirnov p-value of values being independent and uniform in [0, 1); at least 100 values.
inline double kolmogorov_smirnov_p(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    distance = std::max({distance, (static_cast<double>(i) + 1.0) / count - values[i],
                         values[i] - static_cast<double>(i) / count});
  }
  // Stephens's correction (1970) of the limit distribution.
  const double x = distance * (std::sqrt(count) + 0.12 + 0.11 / std::sqrt(count));
  double p = 0.0;
  for (int k = 1; k <= 100; ++k) {
    p += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * x * x);
  }
  return std::clamp(p, 0.0, 1.0);
}

/// Mean events of every bin of `count` bins: flat background plus a Gaussian pulse (bins).
inline std::vector<double> bin_means(std::size_t count, double background, double signal, double centre,
                                     double sigma) {
  const auto phi = [&](double t) { return 0.5 * std::erfc(-(t - centre) / sigma / std::numbers::sqrt2); };
  std::vector<double> means(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = static_cast<double>(i);
    means[i] = background / static_cast<double>(count) + signal * (phi(t + 1.0) - phi(t));
  }
  return means;
}

}  // namespace dtof
