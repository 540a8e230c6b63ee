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

/// Text "value [low, high]", each times `scale`, with `digits` decimals. With few outliers "value [low,
/// high]* low to high"; the second interval allows for unseen outliers. Just "value [low, high]*" if both
/// intervals are equal.
std::string format_estimate(const Estimate& estimate, double scale, int digits);

/// All figures of all points, with intervals in columns of their own; SI units, shares 0 .. 1. Columns
/// `*_low_unseen` and `*_high_unseen` have values only if fewer than kFewOutliers outliers were seen.
Table accuracy_csv(std::span<const AccuracyPoint> points);

/// Table of one estimator by distance, with intervals.
Table accuracy_table(std::span<const AccuracyPoint> points);

/// Table with a row per distance and a column per estimator.
Table accuracy_matrix(std::span<const AccuracyPoint> points,
                      const std::function<std::string(const AccuracyPoint&)>& cell);

/// A line per estimator: `value` against distance.
std::vector<PlotSeries> accuracy_series(std::span<const AccuracyPoint> points,
                                        const std::function<double(const AccuracyPoint&)>& value);

/// Calls `use` with the points of each estimator.
void for_each_estimator(std::span<const AccuracyPoint> points,
                        const std::function<void(std::span<const AccuracyPoint>)>& use);

}  // namespace dtof
