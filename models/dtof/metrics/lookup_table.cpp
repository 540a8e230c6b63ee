// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/lookup_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

CalibrationPoint merged(const CalibrationPoint& a, const CalibrationPoint& b) {
  const double weight = a.weight + b.weight;
  const double share = b.weight / weight;
  return {std::lerp(a.position, b.position, share), std::lerp(a.distance_m, b.distance_m, share), weight};
}

}  // namespace

LookupTable LookupTable::fit(std::span<const CalibrationPoint> points) {
  if (points.size() < 2) {
    throw InputError(
        fmt::format("a look-up table needs at least 2 calibration points, but there are {}", points.size()));
  }
  std::vector<CalibrationPoint> sorted(points.begin(), points.end());
  for (const CalibrationPoint& point : sorted) {
    if (!std::isfinite(point.position) || !std::isfinite(point.distance_m)) {
      throw InputError(fmt::format("calibration point (position {}, distance {} m) is not finite",
                                   point.position, point.distance_m));
    }
    if (!std::isfinite(point.weight) || point.weight <= 0.0) {
      throw InputError(fmt::format("calibration weight is {}, but must be above 0", point.weight));
    }
  }
  std::ranges::stable_sort(sorted, {}, &CalibrationPoint::position);

  std::vector<CalibrationPoint> pools;
  for (auto point = sorted.begin(); point != sorted.end();) {
    CalibrationPoint pool = *point;
    for (++point; point != sorted.end() && point->position == pool.position; ++point) {
      pool = merged(pool, *point);
    }
    while (!pools.empty() && pools.back().distance_m >= pool.distance_m) {
      pool = merged(pools.back(), pool);
      pools.pop_back();
    }
    pools.push_back(pool);
  }
  return LookupTable(std::move(pools));
}

LookupTable::LookupTable(std::vector<CalibrationPoint> knots) : knots_(std::move(knots)) {
  const CalibrationPoint& first = knots_.front();
  const CalibrationPoint& last = knots_.back();
  if (knots_.size() > 1) {
    mean_slope_ = (last.distance_m - first.distance_m) / (last.position - first.position);
  }
}

double LookupTable::distance(double position) const {
  const auto above = std::ranges::upper_bound(knots_, position, {}, &CalibrationPoint::position);
  if (above == knots_.begin() || above == knots_.end()) {
    const CalibrationPoint& end = above == knots_.begin() ? knots_.front() : knots_.back();
    return end.distance_m + mean_slope_ * (position - end.position);
  }
  const CalibrationPoint& below = *(above - 1);
  const double share = (position - below.position) / (above->position - below.position);
  return std::lerp(below.distance_m, above->distance_m, share);
}

}  // namespace dtof
