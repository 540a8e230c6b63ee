// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "accuracy/accuracy_study.hpp"
#include "dtof/metrics/confidence_interval.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"

namespace dtof {

/// "value [low, high]", each times `scale`, with `digits` after the point. With few outliers "value [low,
/// high]* low to high": the second interval allows for outliers that were not seen; "value [low, high]*"
/// where both are the same.
std::string format_estimate(const Estimate& estimate, double scale, int digits);

/// Every figure of every point, intervals as columns of their own; SI units, shares 0 .. 1. Columns
/// `*_low_unseen` and `*_high_unseen` are empty but where fewer than kFewOutliers outliers were seen.
Table accuracy_csv(std::span<const AccuracyPoint> points);

/// A table of one estimator over distance, with intervals.
Table accuracy_table(std::span<const AccuracyPoint> points);

/// Distances down, estimators across.
Table accuracy_matrix(std::span<const AccuracyPoint> points,
                      const std::function<std::string(const AccuracyPoint&)>& cell);

/// A line for each estimator: `value` over distance.
std::vector<PlotSeries> accuracy_series(std::span<const AccuracyPoint> points,
                                        const std::function<double(const AccuracyPoint&)>& value);

/// Calls `use` with each estimator's stretch of `points`.
void for_each_estimator(std::span<const AccuracyPoint> points,
                        const std::function<void(std::span<const AccuracyPoint>)>& use);

}  // namespace dtof
