// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "core/detection.hpp"
#include "core/parameters.hpp"
#include "metrics/confidence_interval.hpp"
#include "photon/sensor_model.hpp"
#include "photon/target_map.hpp"

namespace dtof {

/// Makes the photons of a scene; the exact event-by-event model unless another is chosen.
using SourceFactory =
    std::function<std::unique_ptr<StreamSource>(const SensorModel& sensor, const TargetMap& targets,
                                                double klux, std::uint64_t seed, std::uint32_t frame)>;
std::unique_ptr<StreamSource> make_exact_source(const SensorModel& sensor, const TargetMap& targets,
                                                double klux, std::uint64_t seed, std::uint32_t frame);

/// A distance sweep at one light level. Every read-out sees the same photons, which are generated once.
struct StudySettings {
  SensorModel sensor;
  double klux = 14.0;
  double reflectivity = 1.0;
  std::vector<double> distances_m;
  std::vector<ReadoutParameters> readouts;
  bool matched_filter =
      true;           ///< on a pixel's full histogram, knowing both rates: the single-pixel reference
  int frames = 1000;  ///< a distance; with `precision` the first batch
  std::optional<double> precision;  ///< wanted relative half width of the intervals of precision and rmse
  int most_frames = 100'000;        ///< where `precision` gives up
  bool lookup_table = true;         ///< fit the host's table; without it, distances are those of Eq. 3.11
  int calibration_frames = 200;
  double calibration_step_m = 0.05;
  std::optional<double> rejection;  ///< wanted share of outliers among accepted measurements
  SourceFactory make_source = make_exact_source;
  RunOptions run;
  std::string command;  ///< to reproduce a difference that --verify finds
};

/// One read-out, or the matched filter, at one distance.
struct AccuracyPoint {
  std::string estimator;  ///< readout_name, or "matched-filter"
  std::string title;
  double klux = 0.0;
  double distance_m = 0.0;
  std::uint64_t frames = 0;
  bool precision_reached = true;  ///< true without `precision`
  Estimate relative_precision;    ///< Eq. 3.14, before the look-up table
  Estimate bias_m;                ///< before the look-up table
  std::optional<Estimate>
      slope;        ///< d(depth)/dR over the neighbouring distances, before the table; 1 = ideal
  Estimate rmse_m;  ///< after the look-up table, as everything below
  Estimate above_3_percent;
  Estimate outlier_rate;  ///< error above 10 %
  double cramer_rao_m = 0.0;
  Estimate efficiency;                    ///< Cramer-Rao bound / rmse
  std::optional<Estimate> accepted;       ///< share with enough confidence
  std::optional<Estimate> outliers_kept;  ///< outlier rate of those
};

struct AccuracyStudy {
  std::vector<AccuracyPoint> points;           ///< estimator by estimator, distances ascending
  std::vector<std::string> without_rejection;  ///< titles for which no confidence reaches `rejection`

  /// Throws std::logic_error if the study has no such point.
  [[nodiscard]] const AccuracyPoint& at(const std::string& estimator, double distance_m) const;
};

/// Throws InputError for settings out of range.
AccuracyStudy run_accuracy_study(const StudySettings& settings);

/// A flat scene of `frames` independent pixels. Binning and coincidence make neighbours depend on each other:
/// then only pixels (pitch * i + offset) in both directions count.
struct IndependentPixels {
  int columns = 1;  ///< that count
  int rows = 1;
  int pitch = 1;
  int offset = 0;

  IndependentPixels(const SensorModel& sensor, int frames);
  [[nodiscard]] TargetMap targets(PixelTarget target) const;
  [[nodiscard]] int column(int index) const { return pitch * index + offset; }
  /// Rows that count of a column's stream.
  [[nodiscard]] ColumnStream rows_of(const ColumnStream& stream) const;
};

}  // namespace dtof
