// SPDX-License-Identifier: Apache-2.0
#include "host/walk_correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/error.hpp"

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

}  // namespace

WalkCorrection::WalkCorrection(std::vector<Class> classes) : classes_(std::move(classes)) {}

WalkCorrection WalkCorrection::calibrate(std::span<const TargetRun> runs, double code_step) {
  constexpr double kLeastShare = 0.1;
  std::vector<double> confidences;
  for (const TargetRun& run : runs) {
    for (const Measurement& measurement : run.measurements) {
      if (!std::isfinite(measurement.confidence)) {
        throw InputError(fmt::format("calibration at {} m: confidence {} is not finite", run.distance_m,
                                     measurement.confidence));
      }
      confidences.push_back(measurement.confidence);
    }
  }
  std::vector<Class> classes;
  for (const ConfidenceRange& range : equal_shares(std::move(confidences), kClasses)) {
    std::map<double, TargetRun> by_distance;
    for (const TargetRun& run : runs) {
      std::vector<Measurement> own;
      std::ranges::copy_if(run.measurements, std::back_inserter(own),
                           [&](const Measurement& m) { return range.holds(m.confidence); });
      if (own.empty() ||
          static_cast<double>(own.size()) < kLeastShare * static_cast<double>(run.measurements.size())) {
        continue;
      }
      TargetRun& together =
          by_distance.try_emplace(run.distance_m, TargetRun{run.identity, run.distance_m, {}}).first->second;
      together.measurements.insert(together.measurements.end(), own.begin(), own.end());
    }
    if (by_distance.size() >= 2) {
      std::vector<TargetRun> own_runs;
      for (auto& [distance, run] : by_distance) {
        own_runs.push_back(std::move(run));
      }
      classes.push_back({range.median, RangeConverter::calibrate(own_runs, code_step)});
    }
  }
  if (classes.empty()) {
    throw InputError("walk correction: no class of confidence has two distances to fit a table to");
  }
  return WalkCorrection(std::move(classes));
}

double WalkCorrection::distance(const Measurement& measurement) const {
  const auto above = std::ranges::upper_bound(classes_, measurement.confidence, {}, &Class::confidence);
  if (above == classes_.begin() || above == classes_.end()) {
    const Class& end = above == classes_.begin() ? classes_.front() : classes_.back();
    return end.table.distance(measurement.position);
  }
  const Class& below = *(above - 1);
  const double share = (measurement.confidence - below.confidence) / (above->confidence - below.confidence);
  return std::lerp(below.table.distance(measurement.position), above->table.distance(measurement.position),
                   share);
}

}  // namespace dtof
