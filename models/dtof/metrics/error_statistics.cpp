// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/error_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

void require_same_size(std::size_t first, std::size_t second) {
  if (first != second) {
    throw InputError(fmt::format("{} values cannot be compared with {}", first, second));
  }
}

}  // namespace

void RunningMoments::add(double value) {
  ++count_;
  const double delta = value - mean_;
  mean_ += delta / static_cast<double>(count_);
  squared_deviations_ += delta * (value - mean_);
}

void RunningMoments::merge(const RunningMoments& other) {
  if (other.count_ == 0) {
    return;
  }
  const auto own = static_cast<double>(count_);
  const auto added = static_cast<double>(other.count_);
  const double share = added / (own + added);
  const double delta = other.mean_ - mean_;
  mean_ += delta * share;
  squared_deviations_ += other.squared_deviations_ + delta * delta * own * share;
  count_ += other.count_;
}

double RunningMoments::variance() const {
  return count_ < 2 ? 0.0 : squared_deviations_ / static_cast<double>(count_ - 1);
}

double RunningMoments::mean_square() const {
  return count_ == 0 ? 0.0 : mean_ * mean_ + squared_deviations_ / static_cast<double>(count_);
}

void ErrorStatistics::add(double true_m, double measured_m) {
  if (!std::isfinite(true_m) || true_m <= 0.0) {
    throw InputError(fmt::format("true distance is {} m, but must be above 0", true_m));
  }
  if (!std::isfinite(measured_m)) {
    throw InputError(fmt::format("measured distance is {} m, but must be finite", measured_m));
  }
  const double error = measured_m - true_m;
  const double relative = std::abs(error) / true_m;
  error_.add(error);
  relative_error_.add(relative);
  above_3_percent_ += relative > 0.03 ? 1 : 0;
  above_10_percent_ += relative > 0.10 ? 1 : 0;
}

void ErrorStatistics::merge(const ErrorStatistics& other) {
  error_.merge(other.error_);
  relative_error_.merge(other.relative_error_);
  above_3_percent_ += other.above_3_percent_;
  above_10_percent_ += other.above_10_percent_;
}

ErrorSummary ErrorStatistics::summary() const {
  if (count() == 0) {
    throw InputError("error statistics need at least one measured distance");
  }
  const auto total = static_cast<double>(count());
  return {.count = count(),
          .relative_precision = std::sqrt(relative_error_.variance()),
          .bias_m = error_.mean(),
          .standard_deviation_m = std::sqrt(error_.variance()),
          .rmse_m = std::sqrt(error_.mean_square()),
          .share_above_3_percent = static_cast<double>(above_3_percent_) / total,
          .share_above_10_percent = static_cast<double>(above_10_percent_) / total};
}

ErrorSummary summarise_errors(std::span<const double> true_m, std::span<const double> measured_m) {
  require_same_size(true_m.size(), measured_m.size());
  ErrorStatistics statistics;
  for (std::size_t i = 0; i < true_m.size(); ++i) {
    statistics.add(true_m[i], measured_m[i]);
  }
  return statistics.summary();
}

double median(std::vector<double> values) {
  if (values.empty()) {
    throw InputError("a median needs at least one value");
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

LinearFit fit_line(std::span<const double> x, std::span<const double> y) {
  require_same_size(x.size(), y.size());
  RunningMoments x_moments;
  RunningMoments y_moments;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      throw InputError(fmt::format("point {} of a line fit is not finite: ({}, {})", i, x[i], y[i]));
    }
    x_moments.add(x[i]);
    y_moments.add(y[i]);
  }
  if (std::ranges::adjacent_find(x, std::ranges::not_equal_to()) == x.end()) {
    throw InputError("a line fit needs at least two different x");
  }
  // Centred first: sums of raw products would cancel.
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - x_moments.mean();
    xx += dx * dx;
    xy += dx * (y[i] - y_moments.mean());
  }
  const double slope = xy / xx;
  return {slope, y_moments.mean() - slope * x_moments.mean()};
}

}  // namespace dtof
