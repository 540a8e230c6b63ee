// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/pulse_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

double normal_share_before(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace

PulseResponse::PulseResponse(std::vector<double> samples, double bin_width)
    : bin_width_(bin_width), shares_(std::move(samples)) {
  constexpr std::size_t kMostSamples = 1'000'000;
  if (shares_.size() > kMostSamples) {
    throw InputError(
        fmt::format("pulse response: {} samples are more than {}", shares_.size(), kMostSamples));
  }
  if (!std::isfinite(bin_width) || bin_width <= 0.0) {
    throw InputError(fmt::format("pulse response: the bin width is {}, but must be above 0", bin_width));
  }
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    if (!std::isfinite(shares_[i]) || shares_[i] < 0.0) {
      throw InputError(fmt::format("pulse response: sample {} is {}, but must be at least 0", i, shares_[i]));
    }
  }
  const auto positive = [](double share) { return share > 0.0; };
  shares_.erase(shares_.begin(), std::ranges::find_if(shares_, positive));
  while (!shares_.empty() && shares_.back() == 0.0) {
    shares_.pop_back();
  }
  const double sum = std::reduce(shares_.begin(), shares_.end());
  if (shares_.empty() || !std::isfinite(sum)) {
    throw InputError(fmt::format("pulse response: the sum of the samples is {}", sum));
  }
  double before = 0.0;
  double centroid = 0.0;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    shares_[i] /= sum;
    cumulative_.push_back(std::min(before, 1.0));
    before += shares_[i];
    centroid += shares_[i] * (static_cast<double>(i) + 0.5) * bin_width_;
  }
  cumulative_.push_back(1.0);
  begin_ = -centroid;
}

double PulseResponse::end() const { return begin_ + static_cast<double>(shares_.size()) * bin_width_; }

double PulseResponse::share_before(double time) const {
  const double position = (time - begin_) / bin_width_;
  if (!(position > 0.0)) {
    return 0.0;
  }
  if (position >= static_cast<double>(shares_.size())) {
    return 1.0;
  }
  const auto bin = static_cast<std::size_t>(position);
  return std::lerp(cumulative_[bin], cumulative_[bin + 1], position - static_cast<double>(bin));
}

double PulseResponse::quantile(double share) const {
  const auto after = std::upper_bound(cumulative_.begin(), cumulative_.end(), share);
  if (after == cumulative_.begin()) {
    return begin_;
  }
  if (after == cumulative_.end()) {
    return end();
  }
  const auto bin = static_cast<std::size_t>(after - cumulative_.begin()) - 1;
  const double part = (share - cumulative_[bin]) / (cumulative_[bin + 1] - cumulative_[bin]);
  return begin_ + (static_cast<double>(bin) + part) * bin_width_;
}

double PulseResponse::standard_deviation() const {
  double variance = bin_width_ * bin_width_ / 12.0;
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    const double time = begin_ + (static_cast<double>(i) + 0.5) * bin_width_;
    variance += shares_[i] * time * time;
  }
  return std::sqrt(variance);
}

double PulseResponse::full_width_at_half_maximum() const {
  const double half = 0.5 * *std::ranges::max_element(shares_);
  const auto reaches = [half](double share) { return share >= half; };
  const auto first = static_cast<std::size_t>(std::ranges::find_if(shares_, reaches) - shares_.begin());
  std::size_t last = shares_.size() - 1;
  while (!reaches(shares_[last])) {
    --last;
  }
  // Where the lines between the bins' middles cross; a bin outside the response is empty.
  const auto crossing = [&](double inside, double outside) { return (inside - half) / (inside - outside); };
  const double before = first == 0 ? 0.0 : shares_[first - 1];
  const double after = last + 1 == shares_.size() ? 0.0 : shares_[last + 1];
  return (static_cast<double>(last - first) + crossing(shares_[first], before) +
          crossing(shares_[last], after)) *
         bin_width_;
}

PulseResponse PulseResponse::scaled(double factor) const { return {shares_, bin_width_ * factor}; }

PulseResponse PulseResponse::broadened(double sigma) const {
  // Sorting into bins adds the variance of a bin (Sheppard), which the kernel leaves out.
  const double variance = sigma * sigma - bin_width_ * bin_width_ / 12.0;
  if (variance <= 0.0) {
    return *this;
  }
  sigma = std::sqrt(variance);
  constexpr double kReachSigmas = 6.0;
  const auto reach = static_cast<std::size_t>(std::ceil(kReachSigmas * sigma / bin_width_));
  std::vector<double> kernel(2 * reach + 1);
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double middle = static_cast<double>(i) - static_cast<double>(reach);
    kernel[i] = normal_share_before((middle + 0.5) * bin_width_ / sigma) -
                normal_share_before((middle - 0.5) * bin_width_ / sigma);
  }
  std::vector<double> samples(shares_.size() + 2 * reach, 0.0);
  for (std::size_t i = 0; i < shares_.size(); ++i) {
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      samples[i + k] += shares_[i] * kernel[k];
    }
  }
  return {std::move(samples), bin_width_};
}

}  // namespace dtof
