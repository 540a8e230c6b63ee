// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/pulse_shape.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "dtof/core/pulse_response.hpp"

namespace dtof {

PulseShape::PulseShape(const SensorModel& sensor)
    : sigma_(sensor.pulse_sigma_s() / sensor.time_resolution_s()) {
  const std::shared_ptr<const PulseResponse> response = sensor.pulse_response_bins();
  constexpr double kReachSigmas = 6.2;  // 1e-9 of a Gaussian is beyond
  const double reach = response ? std::max(-response->begin(), response->end()) : kReachSigmas * sigma_;
  reach_ = static_cast<int>(std::ceil(reach + 0.5));
  const auto before = [&](double offset) {
    return response ? response->share_before(offset)
                    : 0.5 * std::erfc(-offset / (sigma_ * std::numbers::sqrt2));
  };
  for (int offset = -reach_; offset <= reach_; ++offset) {
    shares_.push_back(before(offset + 0.5) - before(offset - 0.5));
  }
}

double PulseShape::share(int offset) const {
  const int place = offset + reach_;
  return std::abs(offset) > reach_ ? 0.0 : shares_[static_cast<std::size_t>(place)];
}

}  // namespace dtof
