// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy/accuracy_bench.hpp"
#include "dtof/metrics/error_estimates.hpp"

namespace dtof {

/// Whether the intervals of an accuracy study hold the truth as often as they say.
///
/// Every light level and distance has its photons drawn once for all read-outs: `seeds` runs of the largest
/// number of frames. Runs of fewer frames are parts of these. The truth is the figure over all frames.
struct CoverageSettings {
  StudySettings study;  ///< sensor, read-outs, calibration run, run.seed (the first), run.threads
  std::vector<double> klux;
  std::vector<double> distances_m;
  int seeds = 40;
  std::vector<int> frames = {100, 1000, 10'000};  ///< ascending, each a divisor of the last
  std::vector<double> precisions = {0.10, 0.05};  ///< asked of --precision, looks from frames.front() on
  int other_calibrations = 8;                     ///< calibration runs that the named one is compared with
  /// A table of its own for each seed, which the intervals know nothing of: shows that the study can fail.
  bool calibrate_each_seed = false;
};

enum class Figure { kRelativePrecision, kBias, kRmse, kAbove3Percent, kOutlierRate };
inline constexpr std::array<Figure, 5> kFigures = {Figure::kRelativePrecision, Figure::kBias, Figure::kRmse,
                                                   Figure::kAbove3Percent, Figure::kOutlierRate};
std::string_view figure_name(Figure figure);
const Estimate& figure_of(const ErrorEstimates& errors, Figure figure);

inline constexpr double kLeastSpreadRatio = 0.8;
inline constexpr double kMostSpreadRatio = 1.25;
inline constexpr std::uint64_t kRedrawnRuns = 4000;

/// Spread over runs against reported standard error, and intervals against truth.
struct RunStatistics {
  std::uint64_t runs = 0;
  std::uint64_t covered = 0;         ///< runs whose covering interval holds the truth
  std::uint64_t with_few = 0;        ///< runs that say that they saw few outliers
  double spread = 0.0;               ///< standard deviation of the figure over runs
  double mean_standard_error = 0.0;  ///< as reported

  [[nodiscard]] double spread_ratio() const { return spread / mean_standard_error; }
};

enum class CoverageVerdict {
  kHolds,
  kHoldsRedrawn,  ///< outside with the seeds' own runs, inside with kRedrawnRuns drawn from all frames
  kFails
};

/// One figure of one read-out at one place with one number of frames.
struct CoverageCell {
  std::string estimator;
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  int frames = 0;
  bool after_table = false;
  Figure figure = Figure::kRmse;
  double truth = 0.0;
  RunStatistics seen;
  /// At least half of the runs saw many outliers, or there is none in all frames: the spread is judged.
  /// Otherwise a handful makes the spread, and the share of intervals that hold the truth is judged.
  bool by_spread = true;
  std::optional<RunStatistics> redrawn;
  CoverageVerdict verdict = CoverageVerdict::kHolds;
};

/// How far a figure moves with the table, over other calibration runs; the frames are always the same.
struct TableSpread {
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  Figure figure = Figure::kRmse;
  double named = 0.0;           ///< with the named run's table
  double mean = 0.0;            ///< over the others
  double deviation = 0.0;       ///< over these runs, standard deviation
  double standard_error = 0.0;  ///< reported with `frames`
  int frames = 0;
};

/// --precision on each seed: where it stops, and whether the figures are as exact there as was asked.
struct StoppingCell {
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  double precision = 0.0;
  std::uint64_t seeds = 0;
  std::uint64_t reached = 0;
  std::uint64_t without_outliers = 0;  ///< of those reached, stopped with no outlier seen
  std::uint64_t precision_right = 0;   ///< of those reached, relative precision as near the truth as asked
  std::uint64_t rmse_right = 0;
  double mean_frames = 0.0;      ///< of those reached
  double mean_rmse_error = 0.0;  ///< of those reached: mean of rmse / truth - 1, the bias of stopping

  /// At least 95 % right, as far as so many seeds tell.
  [[nodiscard]] bool holds() const;
};

struct CoverageStudy {
  std::vector<CoverageCell> cells;
  std::vector<TableSpread> tables;
  std::vector<StoppingCell> stopping;
};

/// Throws InputError for settings out of range.
CoverageStudy run_coverage_study(const CoverageSettings& settings);

/// True unless at least 95 % is refuted by `covered` of `runs`.
bool covers_enough(std::uint64_t covered, std::uint64_t runs);

}  // namespace dtof
