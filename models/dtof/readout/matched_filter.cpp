// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/matched_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

// Template values below this change no argmax that noise does not change more.
constexpr double kNegligible = 1e-4;

void require_positive(double value, std::string_view what) {
  if (!std::isfinite(value) || value <= 0.0) {
    throw InputError(fmt::format("matched filter: {} is {}, but must be above 0", what, value));
  }
}

}  // namespace

MatchedFilter::MatchedFilter(const MatchedFilterParameters& parameters) {
  if (parameters.np < 3 || parameters.np > 16) {
    throw InputError(fmt::format("matched filter: NP is {}, but must be 3 to 16", parameters.np));
  }
  require_positive(parameters.sigma_bins, "pulse sigma");
  require_positive(parameters.signal_events, "number of signal events");
  require_positive(parameters.background_events, "number of background events");
  const auto code_count = std::size_t{1} << static_cast<unsigned>(parameters.np);
  no_detection_ = code_count - 1;
  if (parameters.response) {
    match_response(*parameters.response,
                   parameters.signal_events * static_cast<double>(code_count) / parameters.background_events);
  } else {
    match_gaussian(parameters.sigma_bins,
                   parameters.signal_events * std::numbers::inv_sqrtpi / std::numbers::sqrt2 /
                       parameters.sigma_bins /
                       (parameters.background_events / static_cast<double>(code_count)));
  }
  match_bins(parameters);
  counts_.resize(no_detection_);
  scores_.resize(no_detection_ + 2 * reach_);
}

void MatchedFilter::match_gaussian(double sigma_bins, double peak_ratio) {
  const double reach = sigma_bins * std::sqrt(2.0 * std::log(std::max(peak_ratio / kNegligible, 1.0)));
  reach_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(reach)), 1, no_detection_);
  for (std::size_t i = 0; i <= 2 * reach_; ++i) {
    const double z = (static_cast<double>(i) - static_cast<double>(reach_)) / sigma_bins;
    template_.push_back(std::log1p(peak_ratio * std::exp(-0.5 * z * z)));
  }
}

void MatchedFilter::match_response(const PulseResponse& response, double bin_ratio) {
  const double reach = std::max(-response.begin(), response.end()) + 0.5;
  reach_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(reach)), 1, no_detection_);
  for (std::size_t i = 0; i <= 2 * reach_; ++i) {
    const double offset = static_cast<double>(reach_) - static_cast<double>(i);
    const double share = response.share_before(offset + 0.5) - response.share_before(offset - 0.5);
    template_.push_back(std::log1p(bin_ratio * share));
  }
}

void MatchedFilter::match_bins(const MatchedFilterParameters& parameters) {
  if (parameters.returns.empty()) {
    return;
  }
  if (parameters.returns.size() != no_detection_) {
    throw InputError(fmt::format("matched filter: returns of {} bins, but there are {}",
                                 parameters.returns.size(), no_detection_));
  }
  const double background = parameters.background_events / static_cast<double>(no_detection_ + 1);
  of_bin_.resize(no_detection_);
  for (std::size_t bin = 0; bin < no_detection_; ++bin) {
    const double returns = parameters.returns[bin];
    if (!std::isfinite(returns) || returns < 0.0) {
      throw InputError(
          fmt::format("matched filter: returns of bin {} are {}, but must be 0 or more", bin, returns));
    }
    if (returns > 0.0) {
      const double share = background / (background + returns);
      std::ranges::transform(template_, std::back_inserter(of_bin_[bin]),
                             [share](double score) { return std::log1p(std::expm1(score) * share); });
    }
  }
}

std::span<const double> MatchedFilter::scores(std::span<const Detection> detections) {
  std::ranges::fill(counts_, 0.0);
  std::ranges::fill(scores_, 0.0);
  for (const Detection& detection : detections) {
    if (detection.timestamp > no_detection_) {
      throw InputError(
          fmt::format("timestamp {} is above {}, the largest code", detection.timestamp, no_detection_));
    }
    if (detection.timestamp < no_detection_) {
      counts_[detection.timestamp] += 1.0;
    }
  }
  const std::size_t taps = template_.size();
  for (std::size_t bin = 0; bin < no_detection_; ++bin) {
    const double count = counts_[bin];
    if (count != 0.0) {
      double* const score = scores_.data() + bin;
      const double* const pulse =
          of_bin_.empty() || of_bin_[bin].empty() ? template_.data() : of_bin_[bin].data();
      for (std::size_t i = 0; i < taps; ++i) {
        score[i] += count * pulse[i];
      }
    }
  }
  return std::span<const double>(scores_).subspan(reach_, no_detection_);
}

MatchedFilter::Result MatchedFilter::estimate(std::span<const Detection> detections) {
  const std::span<const double> sums = scores(detections);
  const auto best = static_cast<std::size_t>(std::ranges::max_element(sums) - sums.begin());
  return {refined_peak(sums, best), sums[best]};
}

double refined_peak(std::span<const double> scores, std::size_t peak) {
  const auto position = static_cast<double>(peak);
  if (peak == 0 || peak + 1 >= scores.size()) {
    return position;
  }
  const double left = scores[peak] - scores[peak - 1];
  const double right = scores[peak] - scores[peak + 1];
  const bool is_peak = left >= 0.0 && right >= 0.0 && left + right > 0.0;
  return is_peak ? position + 0.5 * (left - right) / (left + right) : position;
}

}  // namespace dtof
