// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/code_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dtof/readout/matched_filter.hpp"
#include "dtof/rival/pulse_shape.hpp"

namespace dtof {
namespace {

// Background whose mean weight is below this share of the root mean square weight is none: a wave cut at one
// code.
constexpr double kNoBackground = 0.01;
constexpr double kLargestCorrelation = 1.0 - 1e-6;  // keeps the evidence of counters without noise finite

double length(std::span<const double> vector) {
  return std::sqrt(std::inner_product(vector.begin(), vector.end(), vector.begin(), 0.0));
}

}  // namespace

CodeMatcher::CodeMatcher(const SensorModel& sensor, std::span<const std::int16_t> weights,
                         std::size_t counters)
    : counters_(counters), codes_((std::size_t{1} << static_cast<unsigned>(sensor.np)) - 1) {
  std::vector<double> sums(counters_, 0.0);
  double squares = 0.0;
  for (std::size_t i = 0; i < codes_ * counters_; ++i) {
    sums[i % counters_] += weights[i];
    squares += static_cast<double>(weights[i]) * weights[i];
  }
  const double per_code = length(sums) / static_cast<double>(codes_);
  if (per_code > kNoBackground * std::sqrt(squares / static_cast<double>(codes_))) {
    const double all = length(sums);
    std::ranges::transform(sums, std::back_inserter(background_), [all](double sum) { return sum / all; });
  }

  const PulseShape pulse(sensor);
  templates_.resize(counters_ * codes_);
  for (std::size_t t = 0; t < codes_; ++t) {
    const int centre = static_cast<int>(t);
    const int begin = std::max(0, centre - pulse.reach());
    const int end = std::min(static_cast<int>(codes_), centre + pulse.reach() + 1);
    std::vector<double> expected(counters_, 0.0);
    for (int x = begin; x < end; ++x) {
      const double share = pulse.share(x - centre);
      for (std::size_t k = 0; k < counters_; ++k) {
        expected[k] += share * weights[static_cast<std::size_t>(x) * counters_ + k];
      }
    }
    project(expected);
    const double norm = length(expected);
    for (std::size_t k = 0; k < counters_; ++k) {
      templates_[k * codes_ + t] = norm > 0.0 ? expected[k] / norm : 0.0;
    }
  }
}

void CodeMatcher::project(std::vector<double>& vector) const {
  if (background_.empty()) {
    return;
  }
  const double along = std::inner_product(vector.begin(), vector.end(), background_.begin(), 0.0);
  for (std::size_t k = 0; k < counters_; ++k) {
    vector[k] -= along * background_[k];
  }
}

std::vector<double> CodeMatcher::correlation(std::span<const std::int32_t> words) const {
  std::vector<double> counts(words.begin(), words.end());
  project(counts);
  const double norm = length(counts);
  std::vector<double> rho(codes_, 0.0);
  constexpr double kRounding = 1e-6;  // what is left of equal counters is no pulse
  if (norm < kRounding) {
    return rho;
  }
  for (std::size_t k = 0; k < counters_; ++k) {
    const double share = counts[k] / norm;
    const double* const row = templates_.data() + k * codes_;
    double* const sum = rho.data();
    for (std::size_t t = 0; t < codes_; ++t) {
      sum[t] += share * row[t];
    }
  }
  return rho;
}

Measurement CodeMatcher::decode(std::span<const std::int32_t> words) const {
  const std::vector<double> rho = correlation(words);
  const auto best = static_cast<std::size_t>(std::ranges::max_element(rho) - rho.begin());
  return {refined_peak(rho, best), rho[best]};
}

std::vector<double> CodeMatcher::evidence(std::span<const std::int32_t> words) const {
  std::vector<double> rho = correlation(words);
  const double dimensions = static_cast<double>(counters_) - (background_.empty() ? 0.0 : 1.0);
  for (double& value : rho) {
    const double alike = std::clamp(value, 0.0, kLargestCorrelation);
    value = -0.5 * dimensions * std::log1p(-alike * alike);
  }
  return rho;
}

}  // namespace dtof
