// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/depth.hpp"

#include <fmt/format.h>

#include <cmath>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"

namespace dtof {

double code_position(const PixelResult& result, int fraction_bits) {
  return result.code + std::ldexp(static_cast<double>(result.fraction), -fraction_bits);
}

DepthScale::DepthScale(double integration_time_s, int np, double fwhm_s) {
  if (!std::isfinite(integration_time_s) || integration_time_s <= 0.0) {
    throw InputError(fmt::format("integration time is {} s, but must be above 0", integration_time_s));
  }
  if (!std::isfinite(fwhm_s) || fwhm_s < 0.0) {
    throw InputError(fmt::format("pulse FWHM is {} s, but must not be negative", fwhm_s));
  }
  if (np < 1 || np > 16) {
    throw InputError(fmt::format("parameter NP is {}, but must be 1 to 16", np));
  }
  bin_depth_ = kSpeedOfLight / 2.0 * std::ldexp(integration_time_s, -np);
  offset_ = kSpeedOfLight / 2.0 * fwhm_s;
}

double DepthScale::depth(double position) const { return bin_depth_ * (position + 0.5) - offset_; }

double DepthScale::position(double depth_m) const { return (depth_m + offset_) / bin_depth_ - 0.5; }

}  // namespace dtof
