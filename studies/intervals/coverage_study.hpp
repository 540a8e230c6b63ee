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

/// Settings of a study that tests whether the intervals of an accuracy study contain the true value as often
/// as stated.
///
/// At every light level and distance, photons are drawn once for all read-outs: `seeds` runs of the largest
/// number of frames. Runs with fewer frames are parts of these. The true value is the figure over all frames.
struct CoverageSettings {
  StudySettings study;  ///< sensor, read-outs, calibration run, run.seed (the first seed), run.threads
  std::vector<double> klux;
  std::vector<double> distances_m;
  int seeds = 40;
  std::vector<int> frames = {100, 1000, 10'000};  ///< ascending, each a divisor of the last
  std::vector<double> precisions = {0.10, 0.05};  ///< of --precision; looks from frames.front() on
  int other_calibrations = 8;                     ///< calibration runs to compare with the named one
  /// Use a separate table for each seed, which the intervals do not allow for. Shows that the study can fail.
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

/// Spread of a figure over runs compared with the reported standard error, and intervals compared with the
/// true value.
struct RunStatistics {
  std::uint64_t runs = 0;
  std::uint64_t covered = 0;         ///< runs whose covering interval contains the true value
  std::uint64_t with_few = 0;        ///< runs that report few outliers
  double spread = 0.0;               ///< standard deviation of the figure over runs
  double mean_standard_error = 0.0;  ///< mean of the reported standard errors

  [[nodiscard]] double spread_ratio() const { return spread / mean_standard_error; }
};

enum class CoverageVerdict {
  kHolds,
  kHoldsRedrawn,  ///< outside with the seeds' own runs, inside with kRedrawnRuns runs drawn from all frames
  kFails
};

/// One figure of one read-out, at one light level and distance, with one number of frames.
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
  /// True if at least half of the runs saw many outliers, or no frame has an outlier: then the spread is
  /// judged. Otherwise a few outliers decide the spread, and the share of intervals that contain the true
  /// value is judged.
  bool by_spread = true;
  std::optional<RunStatistics> redrawn;
  CoverageVerdict verdict = CoverageVerdict::kHolds;
};

/// Change of a figure with the look-up table, over other calibration runs. The frames are always the same.
struct TableSpread {
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  Figure figure = Figure::kRmse;
  double named = 0.0;           ///< with the table of the named calibration run
  double mean = 0.0;            ///< mean over the other runs
  double deviation = 0.0;       ///< standard deviation over these runs
  double standard_error = 0.0;  ///< reported standard error with `frames` frames
  int frames = 0;
};

/// Result of --precision on each seed: where it stops, and whether the figures are then as exact as
/// requested.
struct StoppingCell {
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  double precision = 0.0;
  std::uint64_t seeds = 0;
  std::uint64_t reached = 0;
  std::uint64_t without_outliers = 0;  ///< among the reached ones: stopped without an outlier seen
  /// Among the reached ones: relative precision as close to the true value as requested.
  std::uint64_t precision_right = 0;
  std::uint64_t rmse_right = 0;
  double mean_frames = 0.0;      ///< among the reached ones: mean number of frames
  double mean_rmse_error = 0.0;  ///< of these: mean of rmse / true value - 1, bias of stopping

  /// True if at least 95 % of the runs are right, as far as the number of seeds can tell.
  [[nodiscard]] bool holds() const;
};

struct CoverageStudy {
  std::vector<CoverageCell> cells;
  std::vector<TableSpread> tables;
  std::vector<StoppingCell> stopping;
};

/// Runs the study. Throws InputError for settings out of range.
CoverageStudy run_coverage_study(const CoverageSettings& settings);

/// False if `covered` of `runs` refutes a coverage of at least 95 %.
bool covers_enough(std::uint64_t covered, std::uint64_t runs);

}  // namespace dtof
