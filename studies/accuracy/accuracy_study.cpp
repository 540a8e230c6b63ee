// SPDX-License-Identifier: Apache-2.0
#include "accuracy/accuracy_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "dtof/core/parallel.hpp"

namespace dtof {
namespace {

class Sweep {
 public:
  explicit Sweep(const StudySettings& settings) : settings_(settings), bench_(settings) {}

  AccuracyStudy run() {
    std::vector<double> distances = settings_.distances_m;
    std::ranges::sort(distances);
    distances.erase(std::unique(distances.begin(), distances.end()), distances.end());
    const std::vector<double> calibrated_at =
        settings_.lookup_table ? calibration_distances(settings_, distances) : std::vector<double>();
    Progress progress(fmt::format("{:g} klux", settings_.klux), distances.size() + calibrated_at.size());
    AccuracyStudy study;
    calibrate(calibrated_at, progress, study);
    std::vector<std::vector<AccuracyPoint>> points(bench_.estimators().size());
    for (std::size_t d = 0; d < distances.size(); ++d) {
      evaluate(distances[d], d, points);
      progress.advance();
    }
    for (std::vector<AccuracyPoint>& of_estimator : points) {
      add_slopes(of_estimator);
      std::ranges::move(of_estimator, std::back_inserter(study.points));
    }
    return study;
  }

 private:
  void calibrate(const std::vector<double>& distances, Progress& progress, AccuracyStudy& study) {
    if (distances.empty()) {
      return;
    }
    const std::vector<std::vector<TargetRun>> runs = bench_.calibration_runs(distances, &progress);
    for (std::size_t e = 0; e < runs.size(); ++e) {
      converters_.push_back(bench_.converter(e, runs[e]));
      if (settings_.rejection && !converters_[e].choose_least_confidence(runs[e], *settings_.rejection)) {
        study.without_rejection.push_back(bench_.estimators()[e].title);
      }
    }
  }

  void evaluate(double distance_m, std::size_t index, std::vector<std::vector<AccuracyPoint>>& points) const {
    const std::size_t estimators = bench_.estimators().size();
    std::vector<bool> active(estimators, true);
    std::vector<TargetRun> runs(
        estimators, {AccuracyBench::evaluation_run(settings_.run.seed, index, 0), distance_m, {}});
    for (std::vector<AccuracyPoint>& point : points) {
      point.emplace_back();
    }
    int total = 0;
    // Each batch doubles the frames: few looks at the interval, so that stopping hardly biases it.
    for (std::size_t batch = 0; std::ranges::find(active, true) != active.end(); ++batch) {
      const int wanted = batch == 0 ? settings_.frames : std::min(total, settings_.most_frames - total);
      const AccuracyBench::Batch added = bench_.measure(
          distance_m, wanted, AccuracyBench::evaluation_run(settings_.run.seed, index, batch), active);
      total += wanted;
      parallel_for(estimators, settings_.run.threads, [&](std::size_t e) {
        if (active[e]) {
          std::vector<Measurement>& measurements = runs[e].measurements;
          measurements.insert(measurements.end(), added[e].begin(), added[e].end());
          points[e][index] = summarise(e, runs[e]);
        }
      });
      for (std::size_t e = 0; e < estimators; ++e) {
        active[e] = active[e] && !points[e][index].precision_reached && total < settings_.most_frames;
      }
    }
  }

  [[nodiscard]] AccuracyPoint summarise(std::size_t e, const TargetRun& run) const {
    const auto errors = [&](const MeasuredDistances& measured) {
      return estimate_errors(run.distance_m, measured.distances_m, measured.range_m);
    };
    const ErrorEstimates before = errors(bench_.before_table(run.measurements));
    const ErrorEstimates after =
        converters_.empty() ? before : errors(bench_.after_table(converters_[e], run));
    AccuracyPoint point{};
    point.estimator = bench_.estimators()[e].name;
    point.title = bench_.estimators()[e].title;
    point.klux = settings_.klux;
    point.distance_m = run.distance_m;
    point.frames = run.measurements.size();
    point.relative_precision = before.relative_precision;
    point.bias_m = before.bias_m;
    point.rmse_m = after.rmse_m;
    point.above_3_percent = after.above_3_percent;
    point.outlier_rate = after.outlier_rate;
    point.far_before = before.far_from_others;
    point.far_after = after.far_from_others;
    point.cramer_rao_m = bench_.cramer_rao_m(run.distance_m);
    point.efficiency = reciprocal(point.cramer_rao_m, point.rmse_m);
    if (settings_.rejection) {
      reject(converters_[e], run, point);
    }
    point.precision_reached =
        !settings_.precision ||
        precision_reached(before, after, point.frames, *settings_.precision, settings_.rare_outliers);
    return point;
  }

  static void reject(const RangeConverter& converter, const TargetRun& run, AccuracyPoint& point) {
    std::uint64_t accepted = 0;
    std::uint64_t outliers_kept = 0;
    for (const Measurement& measurement : run.measurements) {
      if (const std::optional<double> distance = converter.convert(measurement)) {
        ++accepted;
        outliers_kept += std::abs(*distance - run.distance_m) > kOutlierError * run.distance_m ? 1 : 0;
      }
    }
    point.accepted = estimate_rare_share(accepted, run.measurements.size());
    if (accepted > 0) {
      point.outliers_kept = estimate_rare_share(outliers_kept, accepted);
    }
  }

  static void add_slopes(std::vector<AccuracyPoint>& points) {
    const auto mean_distance = [](const AccuracyPoint& point) {
      const auto moved = [&](const Interval& interval) {
        return Interval{interval.low + point.distance_m, interval.high + point.distance_m};
      };
      Estimate mean{point.bias_m.value + point.distance_m, moved(point.bias_m.interval)};
      if (point.bias_m.with_unseen) {
        mean.with_unseen = moved(*point.bias_m.with_unseen);
      }
      return mean;
    };
    for (std::size_t d = 0; d < points.size() && points.size() > 1; ++d) {
      const AccuracyPoint& before = points[d == 0 ? 0 : d - 1];
      const AccuracyPoint& after = points[std::min(d + 1, points.size() - 1)];
      points[d].slope =
          estimate_slope(mean_distance(before), mean_distance(after), after.distance_m - before.distance_m);
    }
  }

  const StudySettings& settings_;
  AccuracyBench bench_;
  std::vector<RangeConverter> converters_;  // of each estimator; empty without look-up table
};

}  // namespace

Estimate without_rare_outliers(const Estimate& estimate, std::uint64_t far_from_others, std::uint64_t frames,
                               double rare_outliers) {
  Estimate result = estimate;
  if (far_from_others == 0 && frames > 0 && estimate_rare_share(0, frames).interval.high <= rare_outliers) {
    result.with_unseen.reset();
  }
  return result;
}

bool precision_reached(const ErrorEstimates& before, const ErrorEstimates& after, std::uint64_t frames,
                       double precision, double rare_outliers) {
  const auto known = [&](const Estimate& estimate, std::uint64_t far) {
    const bool few = far < kFewOutliers;
    return estimate.relative_half_width() <= precision &&
           (!few || !without_rare_outliers({0.0, {}, Interval{}}, far, frames, rare_outliers)
                         .with_unseen.has_value());
  };
  return known(before.relative_precision, before.far_from_others) &&
         known(after.rmse_m, after.far_from_others);
}

const AccuracyPoint& AccuracyStudy::at(const std::string& estimator, double distance_m) const {
  const auto found = std::ranges::find_if(points, [&](const AccuracyPoint& point) {
    return point.estimator == estimator && point.distance_m == distance_m;
  });
  if (found == points.end()) {
    throw std::logic_error(fmt::format("the study has no {} at {} m", estimator, distance_m));
  }
  return *found;
}

AccuracyStudy run_accuracy_study(const StudySettings& settings) { return Sweep(settings).run(); }

}  // namespace dtof
