// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "dtof/metrics/error_statistics.hpp"

namespace dtof {

/// Errors of some pixels as reports show them: how many are far off, and by how much all are.
struct ErrorShares {
  std::uint64_t pixels = 0;
  double above_3_percent = 0.0;   ///< share of pixels
  double above_10_percent = 0.0;  ///< share of pixels
  double rmse = 0.0;              ///< of the relative error
};

/// Counts pixel by pixel, in constant memory.
class ErrorShareCounter {
 public:
  /// Distances in m. Throws InputError as ErrorStatistics does.
  void add(double true_m, double measured_m);
  /// All 0 if nothing was added.
  [[nodiscard]] ErrorShares shares() const;

 private:
  ErrorStatistics statistics_;
  RunningMoments relative_error_;
};

/// The pixels of several sets together; the rmse over all of them.
ErrorShares pooled(std::span<const ErrorShares> parts);

}  // namespace dtof
