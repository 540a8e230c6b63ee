// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photon/preset.hpp"

namespace dtof {

/// What the statistics of N frames cost with one photon model, and how far they are from the truth.
struct ErrorCurve {
  std::string model;
  std::vector<int> frames;     ///< N, ascending; empty for a model that draws none
  std::vector<double> cpu_ms;  ///< photons of N frames of a pixel and one read-out, all threads added up
  std::vector<double> error_percent;  ///< rms error of bias and relative precision, % of the distance
};

/// Curves from 100 to 100,000 frames of the exact model, the fast one's streams and sampler, and one point of
/// the analytic model. The error is the rms over the distances 0.5, 1, 2 and 3 m at 14 klux, five read-outs,
/// both quantities and the disjoint sets of N among 100,000 frames; truth is the exact model's answer from
/// `kCurveReferenceFrames` other frames. Noise falls with 1/sqrt(N), a model's own error stays.
inline constexpr int kCurveReferenceFrames = 400'000;
std::vector<ErrorCurve> speed_error_curves(const SensorModel& sensor, std::uint64_t seed, int threads);

}  // namespace dtof
