// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/walk_correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

/// Confidences from `first` to `last`, both included.
struct ConfidenceRange {
  double first;
  double last;
  double median;

  [[nodiscard]] bool holds(double confidence) const { return confidence >= first && confidence <= last; }
};

std::vector<ConfidenceRange> equal_shares(std::vector<double> confidences, std::size_t classes) {
  std::ranges::sort(confidences);
  std::vector<ConfidenceRange> ranges;
  const std::size_t total = confidences.size();
  std::size_t begin = 0;
  while (begin < total) {
    // The remaining measurements are shared by the remaining classes; a value that fills several takes them
    // all.
    const std::size_t left = classes > ranges.size() ? classes - ranges.size() : 1;
    const std::size_t wanted = begin + std::max<std::size_t>(1, (total - begin) / left);
    const double last = confidences[std::min(wanted, total) - 1];
    const auto end =
        static_cast<std::size_t>(std::ranges::upper_bound(confidences, last) - confidences.begin());
    ranges.push_back({confidences[begin], last, confidences[begin + (end - begin) / 2]});
    begin = end;
  }
  return ranges;
}

/// Mean, drawn to 0 as far as its own variance explains it (positive-part James-Stein).
double shrunk_mean(const RunningMoments& moments) {
  const double mean = moments.mean();
  const double variance = moments.variance() / static_cast<double>(moments.count());
  return mean == 0.0 ? 0.0 : mean * std::max(0.0, 1.0 - variance / (mean * mean));
}

}  // namespace

WalkCorrection::WalkCorrection(RangeConverter table, std::vector<Class> classes)
    : table_(std::move(table)), classes_(std::move(classes)) {}

WalkCorrection WalkCorrection::calibrate(std::span<const TargetRun> runs, const RangeConverter& table,
                                         double found_within_m) {
  constexpr double kLeastShare = 0.1;
  constexpr std::uint64_t kLeastMeasurements = 20;
  if (!std::isfinite(found_within_m) || found_within_m <= 0.0) {
    throw InputError(fmt::format("walk correction: the window is {} m, but must be above 0", found_within_m));
  }
  std::vector<double> confidences;
  for (const TargetRun& run : runs) {
    for (const Measurement& measurement : run.measurements) {
      if (!std::isfinite(measurement.confidence)) {
        throw InputError(fmt::format("walk correction: calibration at {} m: confidence {} is not finite",
                                     run.distance_m, measurement.confidence));
      }
      if (std::abs(table.distance(measurement.position) - run.distance_m) <= found_within_m) {
        confidences.push_back(measurement.confidence);
      }
    }
  }
  std::vector<Class> classes;
  for (const ConfidenceRange& range : equal_shares(std::move(confidences), kClasses)) {
    std::map<double, RunningMoments> errors;  // by true distance
    for (const TargetRun& run : runs) {
      RunningMoments own;
      for (const Measurement& measurement : run.measurements) {
        const double error = table.distance(measurement.position) - run.distance_m;
        if (range.holds(measurement.confidence) && std::abs(error) <= found_within_m) {
          own.add(error);
        }
      }
      if (static_cast<double>(own.count()) >= kLeastShare * static_cast<double>(run.measurements.size())) {
        errors[run.distance_m].merge(own);
      }
    }
    Class of_range{range.median, {}};
    for (const auto& [truth_m, error] : errors) {
      if (error.count() >= kLeastMeasurements) {
        of_range.nodes.push_back({truth_m + error.mean(), shrunk_mean(error)});
      }
    }
    if (!of_range.nodes.empty()) {
      std::ranges::stable_sort(of_range.nodes, {}, &Node::distance_m);
      classes.push_back(std::move(of_range));
    }
  }
  return {table, std::move(classes)};
}

double WalkCorrection::Class::error_m(double distance_m) const {
  const auto above = std::ranges::upper_bound(nodes, distance_m, {}, &Node::distance_m);
  if (above == nodes.begin() || above == nodes.end()) {
    return above == nodes.begin() ? nodes.front().error_m : nodes.back().error_m;
  }
  const Node& below = *(above - 1);
  return std::lerp(below.error_m, above->error_m,
                   (distance_m - below.distance_m) / (above->distance_m - below.distance_m));
}

double WalkCorrection::distance(const Measurement& measurement) const {
  const double before = table_.distance(measurement.position);
  if (classes_.empty()) {
    return before;
  }
  const auto above = std::ranges::upper_bound(classes_, measurement.confidence, {}, &Class::confidence);
  if (above == classes_.begin() || above == classes_.end()) {
    return before - (above == classes_.begin() ? classes_.front() : classes_.back()).error_m(before);
  }
  const Class& below = *(above - 1);
  const double share = (measurement.confidence - below.confidence) / (above->confidence - below.confidence);
  return before - std::lerp(below.error_m(before), above->error_m(before), share);
}

}  // namespace dtof
