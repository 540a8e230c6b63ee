// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/accuracy_bench.hpp"
#include "dtof/metrics/confidence_interval.hpp"

namespace dtof {

/// Figures of one read-out, or of the matched filter, at one distance.
struct AccuracyPoint {
  std::string estimator;  ///< readout_name, or "matched-filter"
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  std::uint64_t frames = 0;
  bool precision_reached = true;  ///< always true without `precision`
  Estimate relative_precision;    ///< Eq. 3.14, before the look-up table
  Estimate bias_m;                ///< mean error before the look-up table
  std::optional<Estimate>
      slope;        ///< d(depth)/dR over the neighbouring distances, before the table; 1 = ideal
  Estimate rmse_m;  ///< after the look-up table, as all following figures
  Estimate above_3_percent;
  Estimate outlier_rate;         ///< share of errors above 10 %
  std::uint64_t far_before = 0;  ///< ErrorEstimates::far_from_others before the table
  std::uint64_t far_after = 0;   ///< ErrorEstimates::far_from_others after the table
  double cramer_rao_m = 0.0;
  Estimate efficiency;                    ///< Cramer-Rao bound / rmse
  std::optional<Estimate> accepted;       ///< share of measurements with enough confidence
  std::optional<Estimate> outliers_kept;  ///< outlier rate of the accepted measurements
};

struct AccuracyStudy {
  std::vector<AccuracyPoint> points;  ///< by estimator, then by distance (ascending)
  /// Titles of estimators for which no confidence threshold meets `rejection`.
  std::vector<std::string> without_rejection;

  /// Throws std::logic_error if the study has no such point.
  [[nodiscard]] const AccuracyPoint& at(const std::string& estimator, double distance_m) const;
};

/// True if the errors are known to `precision`. The intervals of relative precision (before the table) and of
/// rmse (after it) must be narrow enough. Outliers must be either frequent enough for valid intervals, or
/// absent in so many frames that their share is below `rare_outliers` (at kConfidenceLevel).
bool precision_reached(const ErrorEstimates& before, const ErrorEstimates& after, std::uint64_t frames,
                       double precision, double rare_outliers);

/// Returns `estimate` without its interval for unseen outliers, if none was seen in so many frames that they
/// are rarer than `rare_outliers` (at kConfidenceLevel). For judgements that such rare outliers do not
/// affect.
Estimate without_rare_outliers(const Estimate& estimate, std::uint64_t far_from_others, std::uint64_t frames,
                               double rare_outliers);

/// Runs the study. Throws InputError for settings out of range.
AccuracyStudy run_accuracy_study(const StudySettings& settings);

}  // namespace dtof
