// SPDX-License-Identifier: Apache-2.0
#include "metrics/confidence_interval.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>

#include "core/error.hpp"
#include "metrics/error_statistics.hpp"

namespace dtof {
namespace {

constexpr double kUpperTail = 0.5 * (1.0 - kConfidenceLevel);

double normal_quantile() {
  static const double quantile =
      boost::math::quantile(boost::math::complement(boost::math::normal_distribution<double>(), kUpperTail));
  return quantile;
}

RunningMoments moments_of(std::span<const double> values, std::size_t least) {
  if (values.size() < least) {
    throw InputError(
        fmt::format("a confidence interval needs at least {} values, not {}", least, values.size()));
  }
  RunningMoments moments;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      throw InputError(fmt::format("a confidence interval of a value that is not finite: {}", value));
    }
    moments.add(value);
  }
  return moments;
}

double standard_error_of_mean(const RunningMoments& moments) {
  return std::sqrt(moments.variance() / static_cast<double>(moments.count()));
}

// Root of a positive quantity that is known with the given relative standard error.
Estimate root_estimate(double square, double relative_error) {
  const double root = std::sqrt(square);
  const double factor = std::exp(0.5 * normal_quantile() * relative_error);
  return {root, {root / factor, root * factor}};
}

}  // namespace

double Estimate::relative_half_width() const {
  const double half_width = 0.5 * (interval.high - interval.low);
  return half_width == 0.0 ? 0.0 : half_width / std::abs(value);
}

Estimate estimate_mean(std::span<const double> values) {
  const RunningMoments moments = moments_of(values, 2);
  const boost::math::students_t_distribution<double> distribution(static_cast<double>(moments.count() - 1));
  const double half_width = boost::math::quantile(boost::math::complement(distribution, kUpperTail)) *
                            standard_error_of_mean(moments);
  return {moments.mean(), {moments.mean() - half_width, moments.mean() + half_width}};
}

Estimate estimate_slope(std::span<const double> first, std::span<const double> second, double distance) {
  const RunningMoments before = moments_of(first, 2);
  const RunningMoments after = moments_of(second, 2);
  if (!std::isfinite(distance) || distance == 0.0) {
    throw InputError(fmt::format("a slope over a distance of {}", distance));
  }
  const double slope = (after.mean() - before.mean()) / distance;
  const double half_width = normal_quantile() / std::abs(distance) *
                            std::hypot(standard_error_of_mean(before), standard_error_of_mean(after));
  return {slope, {slope - half_width, slope + half_width}};
}

Estimate estimate_standard_deviation(std::span<const double> values) {
  const RunningMoments moments = moments_of(values, 4);
  const double variance = moments.variance();
  if (variance == 0.0) {
    return {0.0, {0.0, 0.0}};
  }
  RunningMoments fourth_powers;  // of standardised values: no overflow, no underflow
  const double deviation = std::sqrt(variance);
  for (const double value : values) {
    const double standardised = (value - moments.mean()) / deviation;
    fourth_powers.add(standardised * standardised * standardised * standardised);
  }
  const auto n = static_cast<double>(moments.count());
  const double relative_variance = (fourth_powers.mean() - (n - 3.0) / (n - 1.0)) / n;
  return root_estimate(variance, std::sqrt(std::max(relative_variance, 0.0)));
}

Estimate estimate_root_mean_square(std::span<const double> values) {
  const double square = moments_of(values, 2).mean_square();
  if (square == 0.0) {
    return {0.0, {0.0, 0.0}};
  }
  RunningMoments relative_squares;
  for (const double value : values) {
    relative_squares.add(value / square * value);
  }
  return root_estimate(square, standard_error_of_mean(relative_squares));
}

Estimate estimate_share(std::uint64_t successes, std::uint64_t trials) {
  if (trials == 0 || successes > trials) {
    throw InputError(fmt::format("share of {} successes in {} trials", successes, trials));
  }
  const auto n = static_cast<double>(trials);
  const double share = static_cast<double>(successes) / n;
  const double z2 = normal_quantile() * normal_quantile();
  const double centre = (share + 0.5 * z2 / n) / (1.0 + z2 / n);
  const double half_width =
      normal_quantile() / (1.0 + z2 / n) * std::sqrt(share * (1.0 - share) / n + 0.25 * z2 / (n * n));
  // The ends are exactly 0 and 1 there, but for rounding.
  return {share,
          {successes == 0 ? 0.0 : centre - half_width, successes == trials ? 1.0 : centre + half_width}};
}

Estimate reciprocal(double numerator, const Estimate& estimate) {
  return {numerator / estimate.value,
          {numerator / estimate.interval.high, numerator / estimate.interval.low}};
}

}  // namespace dtof
