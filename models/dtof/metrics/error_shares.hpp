// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "dtof/metrics/error_statistics.hpp"

namespace dtof {

/// Error figures of a set of pixels, as in reports.
struct ErrorShares {
  std::uint64_t pixels = 0;
  double above_3_percent = 0.0;   ///< share of pixels
  double above_10_percent = 0.0;  ///< share of pixels
  double rmse = 0.0;              ///< root mean square of the relative error
};

/// Accumulates error figures pixel by pixel, in constant memory.
class ErrorShareCounter {
 public:
  /// Distances in m. Throws InputError as ErrorStatistics does.
  void add(double true_m, double measured_m);
  /// Figures of all pixels added; all 0 if none was.
  [[nodiscard]] ErrorShares shares() const;

 private:
  ErrorStatistics statistics_;
  RunningMoments relative_error_;
};

/// Figures of several sets of pixels together.
ErrorShares pooled(std::span<const ErrorShares> parts);

}  // namespace dtof
