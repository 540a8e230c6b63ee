// SPDX-License-Identifier: Apache-2.0
#include "intervals/coverage_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "accuracy/accuracy_study.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/random.hpp"
#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

constexpr std::size_t kStates = 2;        // before and after the table
constexpr std::uint64_t kManyRuns = 200;  // their spread is known to 5 %

using Errors = std::array<std::vector<ErrorEstimates>, kStates>;  // of each run

/// All frames of an estimator at one place, seed after seed, as distances.
struct Frames {
  std::array<MeasuredDistances, kStates> measured;
  std::array<ErrorEstimates, kStates> truth;

  [[nodiscard]] ErrorEstimates errors(double true_m, std::size_t state, std::size_t first,
                                      std::size_t count) const {
    return estimate_errors(true_m, std::span(measured[state].distances_m).subspan(first, count),
                           measured[state].range_m);
  }
};

RunStatistics statistics(std::span<const ErrorEstimates> runs, Figure figure, double truth) {
  RunStatistics result;
  RunningMoments values;
  double standard_errors = 0.0;
  for (const ErrorEstimates& run : runs) {
    const Estimate& estimate = figure_of(run, figure);
    const Interval& interval = estimate.covering();
    values.add(estimate.value);
    standard_errors += estimate.standard_error();
    result.covered += interval.low <= truth && truth <= interval.high ? 1 : 0;
    result.with_few += estimate.with_unseen ? 1 : 0;
  }
  result.runs = runs.size();
  result.spread = std::sqrt(values.variance());
  result.mean_standard_error = standard_errors / static_cast<double>(runs.size());
  return result;
}

bool holds(const CoverageCell& cell, const RunStatistics& statistics) {
  if (cell.by_spread) {
    const double ratio = statistics.spread_ratio();
    return kLeastSpreadRatio <= ratio && ratio <= kMostSpreadRatio;
  }
  // Few runs are drawn again as soon as fewer than 95 % of them cover.
  const bool few_runs = statistics.runs < kManyRuns;
  return few_runs ? static_cast<double>(statistics.covered) >=
                        kConfidenceLevel * static_cast<double>(statistics.runs)
                  : covers_enough(statistics.covered, statistics.runs);
}

bool is_share(Figure figure) { return figure == Figure::kAbove3Percent || figure == Figure::kOutlierRate; }

/// The spread says something unless a handful of outliers makes it: the typical run saw enough of them.
bool judged_by_spread(const RunStatistics& seen, Figure figure, const ErrorEstimates& truth) {
  const bool many = 2 * seen.with_few <= seen.runs;
  const bool none = !is_share(figure) && truth.far_from_others == 0;
  return (many || none) && seen.mean_standard_error > 0.0;
}

/// One light level and distance.
class Place {
 public:
  Place(const CoverageSettings& settings, double klux, double distance_m, std::size_t index)
      : settings_(settings),
        study_(at_light(settings.study, klux)),
        bench_(study_),
        distance_m_(distance_m),
        index_(index),
        estimators_(bench_.estimators().size()),
        frames_(estimators_) {}

  CoverageStudy run(Progress& progress) {
    const std::vector<double> calibrated_at = calibration_distances(study_, std::span(&distance_m_, 1));
    const auto calibrate = [&](std::uint64_t seed) {
      StudySettings study = study_;
      study.calibration_seed = seed;
      return converters(study, calibrated_at);
    };
    const std::vector<RangeConverter> named = calibrate(study_.calibration_seed);
    std::vector<std::vector<RangeConverter>> others;
    for (int i = 1; i <= settings_.other_calibrations; ++i) {
      others.push_back(calibrate(study_.calibration_seed + static_cast<std::uint64_t>(i)));
    }
    std::vector<std::vector<ErrorStatistics>> with_other(estimators_,
                                                         std::vector<ErrorStatistics>(others.size()));
    for (int s = 0; s < settings_.seeds; ++s) {
      const std::uint64_t seed = study_.run.seed + static_cast<std::uint64_t>(s);
      const RunIdentity identity = AccuracyBench::evaluation_run(seed, index_, 0);
      AccuracyBench::Batch batch = bench_.measure(distance_m_, settings_.frames.back(), identity,
                                                  std::vector<bool>(estimators_, true));
      const std::vector<RangeConverter> own =
          settings_.calibrate_each_seed ? calibrate(~seed) : std::vector<RangeConverter>();
      parallel_for(estimators_, study_.run.threads, [&](std::size_t e) {
        const TargetRun run{identity, distance_m_, std::move(batch[e])};
        append(frames_[e].measured[0], bench_.before_table(run.measurements));
        append(frames_[e].measured[1], bench_.after_table(own.empty() ? named[e] : own[e], run));
        for (std::size_t i = 0; i < others.size(); ++i) {
          for (const double measured : others[i][e].evaluate(run)) {
            with_other[e][i].add(distance_m_, measured);
          }
        }
      });
      progress.advance();
    }
    std::vector<CoverageStudy> parts(estimators_);
    parallel_for(estimators_, study_.run.threads, [&](std::size_t e) {
      judge(e, parts[e]);
      stop(e, parts[e]);
      compare_tables(e, with_other[e], parts[e]);
    });
    CoverageStudy study;
    for (CoverageStudy& part : parts) {
      std::ranges::move(part.cells, std::back_inserter(study.cells));
      std::ranges::move(part.tables, std::back_inserter(study.tables));
      std::ranges::move(part.stopping, std::back_inserter(study.stopping));
    }
    return study;
  }

 private:
  static StudySettings at_light(StudySettings study, double klux) {
    study.klux = klux;
    return study;
  }

  static void append(MeasuredDistances& all, const MeasuredDistances& added) {
    all.distances_m.insert(all.distances_m.end(), added.distances_m.begin(), added.distances_m.end());
    all.range_m = added.range_m;
  }

  static std::vector<RangeConverter> converters(const StudySettings& study,
                                                std::span<const double> calibrated_at) {
    const AccuracyBench bench(study);
    const std::vector<std::vector<TargetRun>> runs = bench.calibration_runs(calibrated_at, nullptr);
    std::vector<RangeConverter> result;
    for (std::size_t e = 0; e < runs.size(); ++e) {
      result.push_back(bench.converter(e, runs[e]));
    }
    return result;
  }

  [[nodiscard]] std::size_t total() const {
    return static_cast<std::size_t>(settings_.seeds) * static_cast<std::size_t>(settings_.frames.back());
  }

  /// All frames cut into runs.
  [[nodiscard]] Errors seen_runs(const Frames& frames, std::size_t count) const {
    Errors errors;
    for (std::size_t state = 0; state < kStates; ++state) {
      for (std::size_t first = 0; first < total(); first += count) {
        errors[state].push_back(frames.errors(distance_m_, state, first, count));
      }
    }
    return errors;
  }

  /// Runs whose frames are drawn from all frames, with replacement.
  [[nodiscard]] Errors redrawn_runs(const Frames& frames, std::size_t e, std::size_t count) const {
    Errors errors;
    std::vector<double> drawn(count);
    for (std::size_t state = 0; state < kStates; ++state) {
      const std::vector<double>& all = frames.measured[state].distances_m;
      CounterRandom random(study_.run.seed, static_cast<std::uint32_t>(RandomPurpose::kResampling),
                           static_cast<std::uint32_t>(e), static_cast<std::uint32_t>(index_));
      for (std::uint64_t run = 0; run < kRedrawnRuns; ++run) {
        for (double& distance : drawn) {
          distance = all[static_cast<std::size_t>(random.uniform() * static_cast<double>(all.size()))];
        }
        errors[state].push_back(estimate_errors(distance_m_, drawn, frames.measured[state].range_m));
      }
    }
    return errors;
  }

  void judge(std::size_t e, CoverageStudy& study) {
    Frames& frames = frames_[e];
    for (std::size_t state = 0; state < kStates; ++state) {
      frames.truth[state] = frames.errors(distance_m_, state, 0, total());
    }
    for (const int count : settings_.frames) {
      const auto length = static_cast<std::size_t>(count);
      const Errors seen = seen_runs(frames, length);
      Errors redrawn;
      for (std::size_t state = 0; state < kStates; ++state) {
        for (const Figure figure : kFigures) {
          CoverageCell& cell = study.cells.emplace_back();
          cell.estimator = bench_.estimators()[e].name;
          cell.title = bench_.estimators()[e].title;
          cell.klux = study_.klux;
          cell.distance_m = distance_m_;
          cell.frames = count;
          cell.after_table = state == 1;
          cell.figure = figure;
          cell.truth = figure_of(frames.truth[state], figure).value;
          cell.seen = statistics(seen[state], figure, cell.truth);
          cell.by_spread = judged_by_spread(cell.seen, figure, frames.truth[state]);
          if (holds(cell, cell.seen)) {
            continue;
          }
          cell.verdict = CoverageVerdict::kFails;
          // The spread of many runs is known well. A share of intervals is not: at 95 %, one right cell in 40
          // would be refuted.
          if (cell.seen.runs < kManyRuns || !cell.by_spread) {
            if (redrawn[0].empty()) {
              redrawn = redrawn_runs(frames, e, length);
            }
            cell.redrawn = statistics(redrawn[state], figure, cell.truth);
            if (holds(cell, *cell.redrawn)) {
              cell.verdict = CoverageVerdict::kHoldsRedrawn;
            }
          }
        }
      }
    }
  }

  /// Truth of a figure that was taken without far outliers, because none was seen.
  [[nodiscard]] double truth_without_outliers(const MeasuredDistances& measured, Figure figure) const {
    std::vector<double> errors;
    for (const double distance : measured.distances_m) {
      errors.push_back(distance - distance_m_);
    }
    const Outliers outliers = find_outliers(errors);
    RunningMoments relative;
    RunningMoments error;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (!outliers.is_outlier[i]) {
        relative.add(std::abs(errors[i]) / distance_m_);
        error.add(errors[i]);
      }
    }
    return figure == Figure::kRmse ? std::sqrt(error.mean_square()) : std::sqrt(relative.variance());
  }

  void stop(std::size_t e, CoverageStudy& study) const {
    const Frames& frames = frames_[e];
    const auto most = static_cast<std::size_t>(settings_.frames.back());
    std::vector<StoppingCell> cells(settings_.precisions.size());
    const std::array<Figure, kStates> figures = {Figure::kRelativePrecision, Figure::kRmse};
    const std::array<double, kStates> without = {truth_without_outliers(frames.measured[0], figures[0]),
                                                 truth_without_outliers(frames.measured[1], figures[1])};
    for (std::size_t p = 0; p < cells.size(); ++p) {
      cells[p].title = bench_.estimators()[e].title;
      cells[p].klux = study_.klux;
      cells[p].distance_m = distance_m_;
      cells[p].precision = settings_.precisions[p];
      cells[p].seeds = static_cast<std::uint64_t>(settings_.seeds);
    }
    for (std::size_t seed = 0; seed < static_cast<std::size_t>(settings_.seeds); ++seed) {
      std::vector<bool> stopped(cells.size());
      for (auto count = static_cast<std::size_t>(settings_.frames.front());;) {
        const std::array<ErrorEstimates, kStates> errors = {
            frames.errors(distance_m_, 0, seed * most, count),
            frames.errors(distance_m_, 1, seed * most, count)};
        for (std::size_t p = 0; p < cells.size(); ++p) {
          StoppingCell& cell = cells[p];
          if (stopped[p] ||
              !precision_reached(errors[0], errors[1], count, cell.precision, study_.rare_outliers)) {
            continue;
          }
          stopped[p] = true;
          ++cell.reached;
          cell.mean_frames += static_cast<double>(count);
          std::array<bool, kStates> right{};
          std::array<double, kStates> error{};
          bool no_outlier = false;
          for (std::size_t state = 0; state < kStates; ++state) {
            const bool none = errors[state].far_from_others == 0;
            const double truth = none ? without[state] : figure_of(frames.truth[state], figures[state]).value;
            const double rare =
                static_cast<double>(frames.truth[state].far_from_others) / static_cast<double>(total());
            error[state] = figure_of(errors[state], figures[state]).value / truth - 1.0;
            right[state] =
                std::abs(error[state]) <= cell.precision && (!none || rare <= study_.rare_outliers);
            no_outlier = no_outlier || none;
          }
          cell.without_outliers += no_outlier ? 1 : 0;
          cell.precision_right += right[0] ? 1 : 0;
          cell.rmse_right += right[1] ? 1 : 0;
          cell.mean_rmse_error += error[1];
        }
        if (count == most) {
          break;
        }
        count = std::min(2 * count, most);
      }
    }
    for (StoppingCell& cell : cells) {
      if (cell.reached > 0) {
        cell.mean_frames /= static_cast<double>(cell.reached);
        cell.mean_rmse_error /= static_cast<double>(cell.reached);
      }
      study.stopping.push_back(cell);
    }
  }

  void compare_tables(std::size_t e, std::span<const ErrorStatistics> with_other,
                      CoverageStudy& study) const {
    if (with_other.size() < 2) {
      return;
    }
    constexpr std::size_t kFewFrames = 1000;
    const auto count = std::min<std::size_t>(kFewFrames, static_cast<std::size_t>(settings_.frames.back()));
    const ErrorEstimates reported = frames_[e].errors(distance_m_, 1, 0, count);
    for (const Figure figure : {Figure::kRmse, Figure::kAbove3Percent, Figure::kOutlierRate}) {
      RunningMoments values;
      for (const ErrorStatistics& statistics : with_other) {
        const ErrorSummary summary = statistics.summary();
        values.add(figure == Figure::kRmse            ? summary.rmse_m
                   : figure == Figure::kAbove3Percent ? summary.share_above_3_percent
                                                      : summary.share_above_10_percent);
      }
      study.tables.push_back({.title = bench_.estimators()[e].title,
                              .klux = study_.klux,
                              .distance_m = distance_m_,
                              .figure = figure,
                              .deviation = std::sqrt(values.variance()),
                              .standard_error = figure_of(reported, figure).standard_error(),
                              .frames = static_cast<int>(count)});
    }
  }

  const CoverageSettings& settings_;
  StudySettings study_;
  AccuracyBench bench_;
  double distance_m_;
  std::size_t index_;
  std::size_t estimators_;
  std::vector<Frames> frames_;
};

void validate(const CoverageSettings& settings) {
  if (settings.klux.empty() || settings.distances_m.empty() || settings.frames.empty() ||
      settings.seeds < 2) {
    throw InputError("coverage: needs at least one light level, one distance, one frame count and two seeds");
  }
  for (const int count : settings.frames) {
    constexpr int kLeastFrames = 8;
    if (count < kLeastFrames || settings.frames.back() % count != 0) {
      throw InputError(fmt::format("coverage: runs of {} frames; at least {} are needed, and a divisor of {}",
                                   count, kLeastFrames, settings.frames.back()));
    }
  }
}

}  // namespace

std::string_view figure_name(Figure figure) {
  switch (figure) {
    case Figure::kRelativePrecision:
      return "relative precision";
    case Figure::kBias:
      return "bias";
    case Figure::kRmse:
      return "rmse";
    case Figure::kAbove3Percent:
      return "above 3 %";
    default:
      return "above 10 %";
  }
}

const Estimate& figure_of(const ErrorEstimates& errors, Figure figure) {
  switch (figure) {
    case Figure::kRelativePrecision:
      return errors.relative_precision;
    case Figure::kBias:
      return errors.bias_m;
    case Figure::kRmse:
      return errors.rmse_m;
    case Figure::kAbove3Percent:
      return errors.above_3_percent;
    default:
      return errors.outlier_rate;
  }
}

bool covers_enough(std::uint64_t covered, std::uint64_t runs) {
  return estimate_rare_share(covered, runs).interval.high >= kConfidenceLevel;
}

bool StoppingCell::holds() const {
  return reached == 0 || (covers_enough(precision_right, reached) && covers_enough(rmse_right, reached));
}

CoverageStudy run_coverage_study(const CoverageSettings& settings) {
  validate(settings);
  CoverageStudy study;
  Progress progress("coverage", settings.klux.size() * settings.distances_m.size() *
                                    static_cast<std::size_t>(settings.seeds));
  for (const double klux : settings.klux) {
    for (std::size_t d = 0; d < settings.distances_m.size(); ++d) {
      CoverageStudy part = Place(settings, klux, settings.distances_m[d], d).run(progress);
      std::ranges::move(part.cells, std::back_inserter(study.cells));
      std::ranges::move(part.tables, std::back_inserter(study.tables));
      std::ranges::move(part.stopping, std::back_inserter(study.stopping));
    }
  }
  return study;
}

}  // namespace dtof
