// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/confidence_interval.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"
#include "dtof/metrics/error_statistics.hpp"

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

// Clopper and Pearson.
Interval exact_share(std::uint64_t successes, std::uint64_t trials) {
  using Binomial = boost::math::binomial_distribution<double>;
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(successes);
  return {successes == 0 ? 0.0 : Binomial::find_lower_bound_on_p(n, k, kUpperTail),
          successes == trials ? 1.0 : Binomial::find_upper_bound_on_p(n, k, kUpperTail)};
}

double squared(double value) { return value * value; }

/// A sample with few outliers, taken apart.
struct RareOutliers {
  std::vector<double> others;    // values that are no outliers
  std::vector<double> outliers;  // values
  double share;
  Interval share_interval;

  RareOutliers(std::span<const double> values, const Outliers& split)
      : share(static_cast<double>(split.count) / static_cast<double>(values.size())),
        share_interval(exact_share(split.count, values.size())) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      (split.is_outlier[i] ? outliers : others).push_back(values[i]);
    }
  }

  /// Mean of `effect` over the outliers, 0 without any.
  template <typename Effect>
  [[nodiscard]] double mean_effect(Effect effect) const {
    double sum = 0.0;
    for (const double value : outliers) {
      sum += effect(value);
    }
    return outliers.empty() ? 0.0 : sum / static_cast<double>(outliers.size());
  }
};

bool are_few(std::span<const double> values, const Outliers& outliers) {
  if (outliers.is_outlier.size() != values.size()) {
    throw InputError(
        fmt::format("{} values with outliers marked among {}", values.size(), outliers.is_outlier.size()));
  }
  constexpr std::size_t kLeast = 8;  // at least half of the values are no outliers, and four are needed
  return outliers.count < kFewOutliers && values.size() >= kLeast;
}

/// A root of the others' mean square plus what rare outliers add to it; `farthest` is the largest square that
/// an outlier can bring.
Estimate root_with_rare_outliers(double value, const Estimate& others, const RareOutliers& rare,
                                 double mean_added, double farthest) {
  // Outliers that lie nearer to 0 than the others make the square smaller.
  const double of_more = (rare.share_interval.high - rare.share) * mean_added;
  const double of_fewer = (rare.share_interval.low - rare.share) * mean_added;
  const double square = squared(others.value) + rare.share * mean_added;
  const double low =
      square - std::hypot(squared(others.value) - squared(others.interval.low), std::min(of_more, of_fewer));
  const double high =
      square + std::hypot(squared(others.interval.high) - squared(others.value), std::max(of_more, of_fewer));
  const Interval seen{std::sqrt(std::max(low, 0.0)), std::sqrt(high)};
  // The few outliers seen may be bad luck, so that the others alone are right; those unseen may be farther
  // away.
  const double unseen = squared(others.interval.high) + rare.share_interval.high * farthest;
  return {value, seen,
          Interval{std::min(seen.low, others.interval.low), std::max(seen.high, std::sqrt(unseen))}};
}

}  // namespace

double Estimate::standard_error() const { return 0.5 * (interval.high - interval.low) / normal_quantile(); }

Outliers find_outliers(std::span<const double> values) {
  constexpr double kQuartilesPerSigma = 1.349;
  constexpr double kRobustDeviations = 6.0;
  Outliers outliers{std::vector<bool>(values.size()), 0};
  if (values.empty()) {
    return outliers;
  }
  std::vector<double> sorted(values.begin(), values.end());
  const auto at = [&](std::size_t index) {
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(index);
    std::ranges::nth_element(sorted, place);
    return *place;
  };
  const std::size_t last = sorted.size() - 1;
  const double median = at(last / 2);
  const double limit = kRobustDeviations * (at(last - last / 4) - at(last / 4)) / kQuartilesPerSigma;
  for (std::size_t i = 0; i < values.size(); ++i) {
    outliers.is_outlier[i] = std::abs(values[i] - median) > limit;
    outliers.count += outliers.is_outlier[i] ? 1 : 0;
  }
  return outliers;
}

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

Estimate estimate_slope(const Estimate& first, const Estimate& second, double distance) {
  if (!std::isfinite(distance) || distance == 0.0) {
    throw InputError(fmt::format("a slope over a distance of {}", distance));
  }
  const double difference = second.value - first.value;
  const auto slopes = [&](const Interval& before, const Interval& after) {
    const double low = difference - std::hypot(second.value - after.low, before.high - first.value);
    const double high = difference + std::hypot(after.high - second.value, first.value - before.low);
    return Interval{std::min(low / distance, high / distance), std::max(low / distance, high / distance)};
  };
  const bool few = first.with_unseen || second.with_unseen;
  return {difference / distance, slopes(first.interval, second.interval),
          few ? std::optional(slopes(first.covering(), second.covering())) : std::nullopt};
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

Estimate estimate_mean(std::span<const double> values, const Outliers& outliers, const Interval& range) {
  if (!are_few(values, outliers)) {
    return estimate_mean(values);
  }
  const RareOutliers rare(values, outliers);
  const Estimate others = estimate_mean(rare.others);
  const double above = rare.mean_effect([&](double value) { return std::max(value - others.value, 0.0); });
  const double below = rare.mean_effect([&](double value) { return std::max(others.value - value, 0.0); });
  const double mean = others.value + rare.share * (above - below);
  const double fewer = rare.share - rare.share_interval.low;
  const double more = rare.share_interval.high - rare.share;
  const Interval seen{
      mean - std::hypot(others.value - others.interval.low, std::hypot(fewer * above, more * below)),
      mean + std::hypot(others.interval.high - others.value, std::hypot(more * above, fewer * below))};
  const double most = rare.share_interval.high;
  return {mean, seen,
          Interval{std::min(seen.low, others.interval.low - most * (others.value - range.low)),
                   std::max(seen.high, others.interval.high + most * (range.high - others.value))}};
}

Estimate estimate_standard_deviation(std::span<const double> values, const Outliers& outliers,
                                     const Interval& range) {
  const Estimate all = estimate_standard_deviation(values);
  if (!are_few(values, outliers)) {
    return all;
  }
  const RareOutliers rare(values, outliers);
  const Estimate others = estimate_standard_deviation(rare.others);
  const double centre = estimate_mean(rare.others).value;
  const double added =
      rare.mean_effect([&](double value) { return squared(value - centre) - squared(others.value); });
  return root_with_rare_outliers(all.value, others, rare, added,
                                 std::max(squared(range.low - centre), squared(range.high - centre)));
}

Estimate estimate_root_mean_square(std::span<const double> values, const Outliers& outliers,
                                   const Interval& range) {
  const Estimate all = estimate_root_mean_square(values);
  if (!are_few(values, outliers)) {
    return all;
  }
  const RareOutliers rare(values, outliers);
  const Estimate others = estimate_root_mean_square(rare.others);
  const double added = rare.mean_effect([&](double value) { return squared(value) - squared(others.value); });
  return root_with_rare_outliers(all.value, others, rare, added,
                                 std::max(squared(range.low), squared(range.high)));
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

Estimate estimate_rare_share(std::uint64_t successes, std::uint64_t trials) {
  Estimate estimate = estimate_share(successes, trials);
  if (std::min(successes, trials - successes) < kFewOutliers) {
    estimate.interval = exact_share(successes, trials);
    estimate.with_unseen = estimate.interval;
  }
  return estimate;
}

Estimate estimate_share_of_frames(std::span<const double> frames, std::uint64_t pixels_of_a_frame) {
  Estimate estimate = estimate_mean(frames);
  const auto trials = pixels_of_a_frame * frames.size();
  const auto hits = static_cast<std::uint64_t>(std::llround(estimate.value * static_cast<double>(trials)));
  const Interval wilson = estimate_share(hits, trials).interval;
  estimate.interval = {std::max(0.0, std::min(estimate.interval.low, wilson.low)),
                       std::min(1.0, std::max(estimate.interval.high, wilson.high))};
  return estimate;
}

Estimate reciprocal(double numerator, const Estimate& estimate) {
  const auto turned = [&](const Interval& interval) {
    return Interval{numerator / interval.high, numerator / interval.low};
  };
  return {numerator / estimate.value, turned(estimate.interval),
          estimate.with_unseen ? std::optional(turned(*estimate.with_unseen)) : std::nullopt};
}

}  // namespace dtof
