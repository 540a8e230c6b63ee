// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dtof {

/// One row of reports/stability.md: the largest error found over a grid of extreme inputs.
struct StabilityResult {
  std::string what;       ///< function or model
  std::string inputs;     ///< what was swept
  std::string reference;  ///< what it was compared with
  std::uint64_t cases;    ///< values compared
  double error;           ///< largest; NaN in a result counts as infinite
  double limit;           ///< accepted
  std::string unit;       ///< of error and limit

  [[nodiscard]] bool passed() const { return error <= limit; }
};

/// Numerical stability over the extremes that scenes, sensors and calibrations can have, against 50-digit
/// arithmetic, closed forms or exact integers. Random draws use `seed`; their limits are 6 standard
/// deviations, exceeded by a right model twice in 1e9 cases.
std::vector<StabilityResult> check_stability(std::uint64_t seed);

}  // namespace dtof
