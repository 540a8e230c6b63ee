// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/bin_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dtof/readout/matched_filter.hpp"
#include "dtof/rival/pulse_shape.hpp"

namespace dtof {
namespace {

constexpr int kSteps = 30;
constexpr double kStepsPerOctave = 2.0;
constexpr double kLeastRatio = 0.25;
constexpr double kLeastBackground = 0.25;  // counts a bin: an empty bin proves no dark sensor
constexpr double kMarginSigmas = 2.5;

}  // namespace

BinMatcher::BinMatcher(const SensorModel& sensor, int bins, int bin_codes)
    : bins_(static_cast<std::size_t>(bins)),
      codes_(static_cast<std::size_t>(bins) * static_cast<std::size_t>(bin_codes)) {
  const PulseShape pulse(sensor);
  margin_ = static_cast<std::size_t>(std::ceil(kMarginSigmas * pulse.sigma() / bin_codes));
  const auto width = static_cast<std::size_t>(bin_codes);
  const auto reach = static_cast<std::size_t>(pulse.reach());
  taps_ = std::min(bins_, 2 * reach / width + 2);
  std::vector<double> shares(codes_ * taps_, 0.0);
  for (std::size_t t = 0; t < codes_; ++t) {
    const std::size_t first = std::min(t < reach ? 0 : (t - reach) / width, bins_ - taps_);
    first_.push_back(first);
    for (std::size_t x = first * width; x < (first + taps_) * width; ++x) {
      shares[t * taps_ + x / width - first] += pulse.share(static_cast<int>(x) - static_cast<int>(t));
    }
  }
  for (int step = 0; step < kSteps; ++step) {
    const double ratio = kLeastRatio * std::exp2(step / kStepsPerOctave);
    std::vector<double> weights(shares.size());
    std::ranges::transform(shares, weights.begin(), [&](double share) { return std::log1p(ratio * share); });
    weights_.push_back(std::move(weights));
  }
}

std::size_t BinMatcher::step(std::span<const std::int32_t> counts) const {
  std::size_t best = 0;
  for (std::size_t pair = 1; pair + 1 < bins_; ++pair) {
    best = counts[pair] + counts[pair + 1] > counts[best] + counts[best + 1] ? pair : best;
  }
  const std::size_t begin = best - std::min(best, margin_);
  const std::size_t end = std::min(best + 2 + margin_, bins_);
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  const double near = std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(begin),
                                      counts.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
  const auto away = static_cast<double>(bins_ - (end - begin));
  const double background = std::max(
      away > 0.0 ? (all - near) / away : static_cast<double>(std::ranges::min(counts)), kLeastBackground);
  const double signal = near - background * static_cast<double>(end - begin);
  const double ratio = std::max(signal / background, kLeastRatio);
  return static_cast<std::size_t>(std::clamp(
      static_cast<int>(std::lround(kStepsPerOctave * std::log2(ratio / kLeastRatio))), 0, kSteps - 1));
}

std::vector<double> BinMatcher::scores(std::span<const std::int32_t> counts) const {
  const std::vector<double>& weights = weights_[step(counts)];
  std::vector<double> scores(codes_, 0.0);
  for (std::size_t t = 0; t < codes_; ++t) {
    for (std::size_t k = 0; k < taps_; ++k) {
      scores[t] += counts[first_[t] + k] * weights[t * taps_ + k];
    }
  }
  return scores;
}

Measurement BinMatcher::decode(std::span<const std::int32_t> counts) const {
  const std::vector<double> found = scores(counts);
  const auto best = static_cast<std::size_t>(std::ranges::max_element(found) - found.begin());
  return {refined_peak(found, best), found[best]};
}

}  // namespace dtof
