// SPDX-License-Identifier: Apache-2.0
#include "readout/matched_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/error.hpp"

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
  const double peak_ratio = parameters.signal_events * std::numbers::inv_sqrtpi / std::numbers::sqrt2 /
                            parameters.sigma_bins /
                            (parameters.background_events / static_cast<double>(code_count));
  const double reach =
      parameters.sigma_bins * std::sqrt(2.0 * std::log(std::max(peak_ratio / kNegligible, 1.0)));
  reach_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(reach)), 1, no_detection_);
  for (std::size_t i = 0; i <= 2 * reach_; ++i) {
    const double z = (static_cast<double>(i) - static_cast<double>(reach_)) / parameters.sigma_bins;
    template_.push_back(std::log1p(peak_ratio * std::exp(-0.5 * z * z)));
  }
  counts_.resize(no_detection_);
  scores_.resize(no_detection_ + 2 * reach_);
}

MatchedFilter::Result MatchedFilter::estimate(std::span<const Detection> detections) {
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
  const double* const pulse = template_.data();
  for (std::size_t bin = 0; bin < no_detection_; ++bin) {
    const double count = counts_[bin];
    if (count != 0.0) {
      double* const score = scores_.data() + bin;  // the template is symmetric
      for (std::size_t i = 0; i < taps; ++i) {
        score[i] += count * pulse[i];
      }
    }
  }
  const double* const first = scores_.data() + reach_;
  const double* const best = std::max_element(first, first + no_detection_);
  const auto index = best - first;
  Result result{static_cast<double>(index), *best};
  const bool inside = index > 0 && index + 1 < static_cast<std::ptrdiff_t>(no_detection_);
  const double curvature = inside ? 2.0 * best[0] - best[-1] - best[1] : 0.0;
  if (curvature > 0.0) {
    result.position += 0.5 * (best[1] - best[-1]) / curvature;
  }
  return result;
}

}  // namespace dtof
