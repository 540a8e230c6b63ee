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
  bool matched_filter = true;       ///< on a pixel's full histogram, knowing both rates: the reference
  int frames = 1000;                ///< a distance; with `precision` the first batch
  std::optional<double> precision;  ///< wanted relative half width of the intervals of precision and rmse
  double rare_outliers = 1e-3;      ///< `precision` does not wait for outliers rarer than this share
  int most_frames = 100'000;        ///< where `precision` gives up
  bool lookup_table = true;         ///< fit the host's table; without it, distances are those of Eq. 3.11
  /// Names the calibration run. Not `run.seed`: a sensor is calibrated once, and its figures are those of
  /// this one table, whatever is measured with it afterwards.
  std::uint64_t calibration_seed = 1;
  int calibration_frames = 200;
  double calibration_step_m = 0.05;
  std::optional<double> rejection;  ///< wanted share of outliers among accepted measurements
  SourceFactory make_source = make_exact_source;
  RunSettings run;
  std::string command;  ///< to reproduce a difference that --verify finds

  /// Throws InputError for settings out of range.
  void validate() const;
};

/// A flat scene of `frames` independent pixels. Binning and coincidence make neighbours depend on each other:
/// then only pixels (pitch * i + offset) in both directions count. Pool read-outs make all pixels of a column
/// depend on each other: then columns are as high as the thesis's array, and only one pixel of each counts.
/// Where columns hear each other, too, a pixel has an engine of several columns of its own.
struct IndependentPixels {
  int columns = 1;  ///< that count
  int rows = 1;     ///< that count
  int pitch = 1;
  int offset = 0;
  int height = 1;     ///< of a column, in rows of `pitch`
  int first_row = 0;  ///< that counts, of these
  int engine = 1;     ///< columns of a pixel's own; that in their middle counts, the right one of a pair

  IndependentPixels(const SensorModel& sensor, int frames, bool pooled = false, int engine_columns = 1);
  [[nodiscard]] TargetMap targets(PixelTarget target) const;
  [[nodiscard]] int column(int index) const { return pitch * index + offset; }
  /// The column at `place` of a pixel's engine.
  [[nodiscard]] int column(int index, int place) const { return column(index * engine + place); }
  [[nodiscard]] int row(int index) const { return pitch * (first_row + index) + offset; }
  /// One stream for each of `height` rows.
  [[nodiscard]] ColumnStream whole_column(const ColumnStream& stream) const;
  /// Only the rows that count.
  [[nodiscard]] ColumnStream counted_rows(const ColumnStream& stream) const;
};

/// A read-out, or the matched filter of the single pixel.
struct Estimator {
  std::string name;  ///< readout_name, or "matched-filter"
  std::string title;
  std::optional<ReadoutParameters> readout;  ///< none: the matched filter
};

/// Distances of a run, and those that can come out at all.
struct MeasuredDistances {
  std::vector<double> distances_m;
  Interval range_m;
};

/// The distances of a calibration run that brackets `distances` (ascending): multiples of the settings' step,
/// each with photons of its own, whatever the other distances are.
std::vector<double> calibration_distances(const StudySettings& settings, std::span<const double> distances);

/// Read-outs in front of a wall: measures, calibrates, judges. Settings must outlive it.
class AccuracyBench {
 public:
  using Batch = std::vector<std::vector<Measurement>>;  ///< estimator, frame

  explicit AccuracyBench(const StudySettings& settings);

  [[nodiscard]] const std::vector<Estimator>& estimators() const { return estimators_; }

  /// Photons of an evaluation. Those of a calibration are others whatever the seeds are.
  /// Throws InputError for too many points or batches.
  [[nodiscard]] static RunIdentity evaluation_run(std::uint64_t seed, std::size_t point, std::size_t batch);

  /// Independent frames of a wall at `distance_m`, of the estimators that are active.
  [[nodiscard]] Batch measure(double distance_m, int frames, const RunIdentity& identity,
                              const std::vector<bool>& active) const;

  /// Runs of a calibration at these distances for each estimator, from the settings' seed.
  [[nodiscard]] std::vector<std::vector<TargetRun>> calibration_runs(std::span<const double> distances,
                                                                     Progress* progress) const;
  [[nodiscard]] RangeConverter converter(std::size_t estimator, std::span<const TargetRun> runs) const;

  /// Distances of Eq. 3.11.
  [[nodiscard]] MeasuredDistances before_table(std::span<const Measurement> measurements) const;
  [[nodiscard]] MeasuredDistances after_table(const RangeConverter& converter, const TargetRun& run) const;

  /// Standard deviation that no unbiased estimate of the arrival time goes below, m.
  [[nodiscard]] double cramer_rao_m(double distance_m) const;

 private:
  void read_rtl(const StreamSource& source, const IndependentPixels& pixels,
                const ReadoutParameters& parameters, std::vector<Measurement>& measurements) const;
  /// Measurements of all rows of the judged column, in the engine that has pixel number `index`.
  [[nodiscard]] std::vector<Measurement> read_engine(const StreamSource& source,
                                                     const IndependentPixels& pixels, int index,
                                                     const ReadoutParameters& readout) const;
  /// Measurements of all rows of the stream.
  [[nodiscard]] std::vector<Measurement> read_model(const ColumnStream& stream, const Estimator& estimator,
                                                    double distance_m) const;
  [[nodiscard]] PixelRates stream_rates(double distance_m) const;

  const StudySettings& settings_;
  std::vector<Estimator> estimators_;
  bool pooled_;  // a pool read-out is among them
  int engine_;   // columns of a pixel's engine
  DepthScale scale_;
};

}  // namespace dtof
