// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/range_converter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/metrics/depth.hpp"

namespace dtof {
namespace {

constexpr double kFinestStep = 1e-3;  // bins; keeps the weight of equal continuous positions finite

struct Median {
  double value;
  double variance;  // of the median itself
};

/// Median of values on a raster of `step`: values of the median's code are taken as spread evenly over it.
Median median_position(const TargetRun& run, double step) {
  std::vector<double> positions;
  positions.reserve(run.measurements.size());
  for (const Measurement& measurement : run.measurements) {
    if (!std::isfinite(measurement.position)) {
      throw InputError(fmt::format("calibration at {} m: position {} is not finite", run.distance_m,
                                   measurement.position));
    }
    positions.push_back(measurement.position);
  }
  std::ranges::sort(positions);
  const std::size_t last = positions.size() - 1;
  const double middle = positions[last / 2];
  const auto [first_equal, end_equal] = std::equal_range(positions.begin(), positions.end(), middle);
  const auto below = static_cast<double>(first_equal - positions.begin());
  const auto equal = static_cast<double>(end_equal - first_equal);
  const auto count = static_cast<double>(positions.size());
  // As for a normal distribution with these quartiles, but no finer than the raster.
  constexpr double kQuartilesPerSigma = 1.349;
  const double quartiles = positions[last - last / 4] - positions[last / 4];
  const double sigma = std::max({quartiles / kQuartilesPerSigma, step, kFinestStep});
  return {middle + step * ((0.5 * count - below) / equal - 0.5),
          0.5 * std::numbers::pi * sigma * sigma / count};
}

/// The runs before the positions stop growing, judged by a bound that noise does not lift.
std::span<const CalibrationPoint> growing_part(std::span<const CalibrationPoint> by_distance) {
  constexpr double kStandardErrors = 2.0;
  const auto bound = [](const CalibrationPoint& point) {
    return point.position - kStandardErrors / std::sqrt(point.weight);
  };
  const auto last = std::ranges::max_element(by_distance, {}, bound);
  const auto kept = static_cast<std::size_t>(last - by_distance.begin()) + 1;
  return by_distance.first(std::max<std::size_t>(kept, 2));
}

}  // namespace

Measurement to_measurement(const PixelResult& result, int fraction_bits) {
  return {code_position(result, fraction_bits), static_cast<double>(result.confidence)};
}

RangeConverter::RangeConverter(LookupTable table, double reach_m, std::vector<RunIdentity> seen)
    : table_(std::move(table)),
      reach_m_(reach_m),
      seen_(std::move(seen)),
      least_confidence_(-std::numeric_limits<double>::infinity()) {
  std::ranges::sort(seen_);
}

RangeConverter RangeConverter::calibrate(std::span<const TargetRun> runs, double code_step) {
  std::vector<CalibrationPoint> points;
  std::vector<RunIdentity> seen;
  for (const TargetRun& run : runs) {
    if (run.measurements.empty()) {
      throw InputError(fmt::format("calibration at {} m has no measurement", run.distance_m));
    }
    if (!std::isfinite(run.distance_m) || run.distance_m <= 0.0) {
      throw InputError(fmt::format("calibration distance is {} m, but must be above 0", run.distance_m));
    }
    const Median median = median_position(run, code_step);
    points.push_back({median.value, run.distance_m, 1.0 / median.variance});
    seen.push_back(run.identity);
  }
  if (points.size() < 2) {
    throw InputError(fmt::format("calibration needs at least 2 runs, not {}", points.size()));
  }
  std::ranges::sort(points, {}, &CalibrationPoint::distance_m);
  const std::span<const CalibrationPoint> used = growing_part(points);
  return {LookupTable::fit(used), used.back().distance_m, std::move(seen)};
}

bool RangeConverter::choose_least_confidence(std::span<const TargetRun> runs, double share,
                                             double tolerance) {
  struct Judged {
    double confidence;
    bool wrong;
  };
  std::vector<Judged> judged;
  for (const TargetRun& run : runs) {
    for (const Measurement& measurement : run.measurements) {
      const double error = std::abs(distance(measurement.position) - run.distance_m);
      judged.push_back({measurement.confidence, error > tolerance * run.distance_m});
    }
  }
  std::ranges::sort(judged, std::ranges::greater(), &Judged::confidence);
  std::optional<double> lowest;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    wrong += judged[i].wrong ? 1 : 0;
    const bool last_of_ties = i + 1 == judged.size() || judged[i + 1].confidence != judged[i].confidence;
    if (last_of_ties && static_cast<double>(wrong) <= share * static_cast<double>(i + 1)) {
      lowest = judged[i].confidence;
    }
  }
  if (lowest) {
    least_confidence_ = *lowest;
  }
  return lowest.has_value();
}

std::optional<double> RangeConverter::convert(const Measurement& measurement) const {
  if (measurement.confidence < least_confidence_) {
    return std::nullopt;
  }
  return distance(measurement.position);
}

std::vector<double> RangeConverter::evaluate(const TargetRun& run) const {
  if (std::ranges::binary_search(seen_, run.identity)) {
    throw std::logic_error(fmt::format("run (seed {}, frame {}) at {} m calibrated the table it would judge",
                                       run.identity.seed, run.identity.frame, run.distance_m));
  }
  std::vector<double> distances;
  distances.reserve(run.measurements.size());
  for (const Measurement& measurement : run.measurements) {
    distances.push_back(distance(measurement.position));
  }
  return distances;
}

}  // namespace dtof
