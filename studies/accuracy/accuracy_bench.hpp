// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_estimates.hpp"
#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "run/run_settings.hpp"

namespace dtof {

/// Makes the photon source of a scene. Default: the exact event-by-event model.
using SourceFactory =
    std::function<std::unique_ptr<StreamSource>(const SensorModel& sensor, const TargetMap& targets,
                                                double klux, std::uint64_t seed, std::uint32_t frame)>;
std::unique_ptr<StreamSource> make_exact_source(const SensorModel& sensor, const TargetMap& targets,
                                                double klux, std::uint64_t seed, std::uint32_t frame);

/// A distance sweep at one light level. All read-outs see the same photons, which are generated once.
struct StudySettings {
  SensorModel sensor;
  double klux = 14.0;
  double reflectivity = 1.0;
  std::vector<double> distances_m;
  std::vector<ReadoutParameters> readouts;
  bool matched_filter = true;  ///< also measure the reference: a matched filter on each pixel's full
                               ///< histogram, with known signal and background rates
  int frames = 1000;           ///< frames per distance; with `precision`, of the first batch
  /// Relative half width of the intervals of precision and rmse at which to stop.
  std::optional<double> precision;
  double rare_outliers = 1e-3;  ///< outliers rarer than this share do not delay `precision`
  int most_frames = 100'000;    ///< limit on frames if `precision` is not reached
  bool lookup_table = true;     ///< fit the host's look-up table; without it, distances follow Eq. 3.11
  /// Seed of the calibration run. It differs from `run.seed` because a sensor is calibrated once: its figures
  /// belong to this one table, whatever is measured later.
  std::uint64_t calibration_seed = 1;
  int calibration_frames = 200;
  double calibration_step_m = 0.05;
  std::optional<double> rejection;  ///< largest share of outliers among accepted measurements
  SourceFactory make_source = make_exact_source;
  RunSettings run;
  std::string command;  ///< command that reproduces a difference found by --verify

  /// Throws InputError for settings out of range.
  void validate() const;
};

/// A flat scene of `frames` independent pixels.
///
/// Binning and coincidence make neighbours depend on each other: then only pixels (pitch * i + offset) in
/// both directions count. Pool read-outs make all pixels of a column depend on each other: then columns are
/// as high as the thesis's array, and one pixel of each counts. If columns depend on each other, too, each
/// counted pixel has an engine of several columns.
struct IndependentPixels {
  int columns = 1;  ///< counted columns
  int rows = 1;     ///< counted rows
  int pitch = 1;
  int offset = 0;
  int height = 1;     ///< rows of a column, in units of `pitch`
  int first_row = 0;  ///< first counted row, in the same units
  int engine = 1;     ///< columns of an engine; the middle one counts, the right one of a middle pair

  IndependentPixels(const SensorModel& sensor, int frames, bool pooled = false, int engine_columns = 1);
  [[nodiscard]] TargetMap targets(PixelTarget target) const;
  [[nodiscard]] int column(int index) const { return pitch * index + offset; }
  /// Column at position `place` of the engine with number `index`.
  [[nodiscard]] int column(int index, int place) const { return column(index * engine + place); }
  [[nodiscard]] int row(int index) const { return pitch * (first_row + index) + offset; }
  /// The stream with one row for each of `height` rows.
  [[nodiscard]] ColumnStream whole_column(const ColumnStream& stream) const;
  /// The stream with the counted rows only.
  [[nodiscard]] ColumnStream counted_rows(const ColumnStream& stream) const;
};

/// A read-out, or the matched filter of single pixels.
struct Estimator {
  std::string name;  ///< readout_name, or "matched-filter"
  std::string title;
  std::optional<ReadoutParameters> readout;  ///< none: the matched filter
};

/// Distances of a run, and the range of all possible distances.
struct MeasuredDistances {
  std::vector<double> distances_m;
  Interval range_m;
};

/// Distances of a calibration run that brackets `distances` (ascending): multiples of the settings' step.
/// Each has photons of its own that do not depend on the other distances.
std::vector<double> calibration_distances(const StudySettings& settings, std::span<const double> distances);

/// Measures a flat target with several read-outs, calibrates, and computes errors. The settings must outlive
/// the bench.
class AccuracyBench {
 public:
  using Batch = std::vector<std::vector<Measurement>>;  ///< [estimator][frame]

  explicit AccuracyBench(const StudySettings& settings);

  [[nodiscard]] const std::vector<Estimator>& estimators() const { return estimators_; }

  /// Identity of the photons of an evaluation; they differ from those of all calibrations for any seeds.
  /// Throws InputError for too many points or batches.
  [[nodiscard]] static RunIdentity evaluation_run(std::uint64_t seed, std::size_t point, std::size_t batch);

  /// Measures independent frames of a flat target at `distance_m` with the active estimators.
  [[nodiscard]] Batch measure(double distance_m, int frames, const RunIdentity& identity,
                              const std::vector<bool>& active) const;

  /// Calibration runs at these distances for each estimator, with the settings' seed.
  [[nodiscard]] std::vector<std::vector<TargetRun>> calibration_runs(std::span<const double> distances,
                                                                     Progress* progress) const;
  [[nodiscard]] RangeConverter converter(std::size_t estimator, std::span<const TargetRun> runs) const;

  /// Distances by Eq. 3.11.
  [[nodiscard]] MeasuredDistances before_table(std::span<const Measurement> measurements) const;
  [[nodiscard]] MeasuredDistances after_table(const RangeConverter& converter, const TargetRun& run) const;

  /// Cramer-Rao bound: least standard deviation of an unbiased distance estimate, m.
  [[nodiscard]] double cramer_rao_m(double distance_m) const;

 private:
  void read_rtl(const StreamSource& source, const IndependentPixels& pixels,
                const ReadoutParameters& parameters, std::vector<Measurement>& measurements) const;
  /// Measurements of all rows of the counted column in the engine of pixel `index`.
  [[nodiscard]] std::vector<Measurement> read_engine(const StreamSource& source,
                                                     const IndependentPixels& pixels, int index,
                                                     const ReadoutParameters& readout) const;
  /// Measurements of all rows of the stream.
  [[nodiscard]] std::vector<Measurement> read_model(const ColumnStream& stream, const Estimator& estimator,
                                                    double distance_m) const;
  [[nodiscard]] PixelRates stream_rates(double distance_m) const;

  const StudySettings& settings_;
  std::vector<Estimator> estimators_;
  bool pooled_;  // some estimator is a pool read-out
  int engine_;   // columns of an engine
  DepthScale scale_;
};

}  // namespace dtof
