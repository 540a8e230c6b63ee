// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy_bench.hpp"
#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

/// One read-out, or the matched filter, at one distance.
struct AccuracyPoint {
  std::string estimator;  ///< readout_name, or "matched-filter"
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  std::uint64_t frames = 0;
  bool precision_reached = true;  ///< true without `precision`
  Estimate relative_precision;    ///< Eq. 3.14, before the look-up table
  Estimate bias_m;                ///< before the look-up table
  std::optional<Estimate>
      slope;        ///< d(depth)/dR over the neighbouring distances, before the table; 1 = ideal
  Estimate rmse_m;  ///< after the look-up table, as everything below
  Estimate above_3_percent;
  Estimate outlier_rate;         ///< error above 10 %
  std::uint64_t far_before = 0;  ///< ErrorEstimates::far_from_others before the table
  std::uint64_t far_after = 0;   ///< and after it
  double cramer_rao_m = 0.0;
  Estimate efficiency;                    ///< Cramer-Rao bound / rmse
  std::optional<Estimate> accepted;       ///< share with enough confidence
  std::optional<Estimate> outliers_kept;  ///< outlier rate of those
};

struct AccuracyStudy {
  std::vector<AccuracyPoint> points;           ///< estimator by estimator, distances ascending
  std::vector<std::string> without_rejection;  ///< titles for which no confidence reaches `rejection`

  /// Throws std::logic_error if the study has no such point.
  [[nodiscard]] const AccuracyPoint& at(const std::string& estimator, double distance_m) const;
};

/// Whether errors are known to `precision`: the intervals of relative precision before the table and of the
/// rmse after it are that narrow, and outliers are either so many that the intervals hold, or none was seen
/// in so many frames that their share is below `rare_outliers` (at kConfidenceLevel).
bool precision_reached(const ErrorEstimates& before, const ErrorEstimates& after, std::uint64_t frames,
                       double precision, double rare_outliers);

/// `estimate` for a judgement that does not mind outliers rarer than `rare_outliers`: where none was seen in
/// so many frames that they are rarer (at kConfidenceLevel), it loses its interval for unseen outliers.
Estimate without_rare_outliers(const Estimate& estimate, std::uint64_t far_from_others, std::uint64_t frames,
                               double rare_outliers);

/// Throws InputError for settings out of range.
AccuracyStudy run_accuracy_study(const StudySettings& settings);

}  // namespace dtof
