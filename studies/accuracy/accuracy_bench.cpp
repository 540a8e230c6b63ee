// SPDX-License-Identifier: Apache-2.0
#include "accuracy/accuracy_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "dtof/analytic/pulse_match.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/readout/matched_filter.hpp"
#include "dtof/readout/model.hpp"
#include "run/readout_run.hpp"

namespace dtof {
namespace {

std::vector<Estimator> make_estimators(const StudySettings& settings) {
  std::vector<Estimator> estimators;
  for (const ReadoutParameters& readout : settings.readouts) {
    estimators.push_back(
        {std::string(readout_name(readout.readout)), std::string(readout_title(readout.readout)), readout});
  }
  if (settings.matched_filter) {
    estimators.push_back({"matched-filter", "matched filter (single pixel)", std::nullopt});
  }
  return estimators;
}

// Calibration and evaluation draw from disjoint halves of a seed's frames, so that they share no photon
// whatever their seeds.
enum class Use : std::uint32_t { kEvaluation = 0, kCalibration = 1 };

RunIdentity run_identity(std::uint64_t seed, Use use, std::size_t point, std::size_t batch) {
  constexpr std::size_t kPoints = 1U << 14U;
  constexpr std::size_t kBatches = 1U << 17U;
  if (point >= kPoints || batch >= kBatches) {
    throw InputError(
        fmt::format("accuracy: more than {} distances or {} batches of frames", kPoints, kBatches));
  }
  return {seed, static_cast<std::uint32_t>((static_cast<std::size_t>(use) << 31U) | (batch << 14U) | point)};
}

bool uses_other_columns(const ReadoutParameters& readout) { return readout.columns_together() > 1; }

/// Columns of a pixel's engine: the pixel's own pair and one pair on either side, on which its result
/// depends. A sensor's engines have more columns, but the photons of all these columns are drawn for each
/// pixel.
int columns_of_engine(std::span<const ReadoutParameters> readouts) {
  constexpr int kPairs = 3;
  int columns = 1;
  for (const ReadoutParameters& readout : readouts) {
    columns = std::max(columns, std::min(readout.columns_together(), 2 * kPairs));
  }
  return columns;
}

std::size_t calibration_index(const StudySettings& settings, double distance_m) {
  return static_cast<std::size_t>(std::lround(distance_m / settings.calibration_step_m));
}

}  // namespace

void StudySettings::validate() const {
  sensor.validate();
  constexpr int kLeastFrames = 4;  // a standard deviation's interval needs them
  if (frames < kLeastFrames || calibration_frames < 1) {
    throw InputError(
        fmt::format("accuracy: needs at least {} frames a distance and 1 to calibrate, not {} and {}",
                    kLeastFrames, frames, calibration_frames));
  }
  if (precision && !(*precision > 0.0)) {
    throw InputError(fmt::format("accuracy: the precision must be above 0, not {}", *precision));
  }
  if (!std::isfinite(calibration_step_m) || calibration_step_m <= 0.0) {
    throw InputError(
        fmt::format("accuracy: the calibration step is {} m, but must be above 0", calibration_step_m));
  }
  if (!(rare_outliers > 0.0 && rare_outliers < 1.0)) {
    throw InputError(
        fmt::format("accuracy: the share of rare outliers must be between 0 and 1, not {}", rare_outliers));
  }
  if (distances_m.empty() || (readouts.empty() && !matched_filter)) {
    throw InputError("accuracy: needs at least one distance and one read-out");
  }
  for (const double distance : distances_m) {
    if (!std::isfinite(distance) || distance <= 0.0) {
      throw InputError(fmt::format("accuracy: distances must be finite and above 0, not {} m", distance));
    }
  }
  if (run.hardware() && std::ranges::any_of(readouts, uses_other_columns)) {
    throw InputError(
        fmt::format("accuracy: --engine {}: an engine of poolPointer is one pixel's here, so that only its "
                    "model reads it",
                    run.engine));
  }
  if (rejection && !lookup_table) {
    throw InputError("accuracy: rejection by confidence needs the calibration run");
  }
  for (const ReadoutParameters& readout : readouts) {
    if (readout.np != sensor.np || readout.slots != sensor.slots) {
      throw std::logic_error("accuracy: NP and SLOTS of a read-out and of the sensor differ");
    }
  }
}

std::vector<double> calibration_distances(const StudySettings& settings, std::span<const double> distances) {
  const SensorModel& sensor = settings.sensor;
  const double farthest = 0.5 * kSpeedOfLight * (sensor.integration_time_s - sensor.pulse_fwhm_s);
  const double step = settings.calibration_step_m;
  // Beyond both ends, so that no evaluated distance is extrapolated but those nearer than a step.
  const double begin = std::max(0.5 * distances.front(), distances.front() - 4.0 * step);
  const double end = std::min(distances.back() + 4.0 * step, farthest);
  const auto first = std::max<std::int64_t>(std::llround(std::floor(begin / step)), 1);
  const auto last = std::max<std::int64_t>(std::llround(std::floor(end / step)), first + 2);
  std::vector<double> sweep;
  for (std::int64_t i = first; i <= last; ++i) {
    sweep.push_back(static_cast<double>(i) * step);
  }
  return sweep;
}

AccuracyBench::AccuracyBench(const StudySettings& settings)
    : settings_(settings),
      estimators_(make_estimators(settings)),
      pooled_(std::ranges::any_of(settings.readouts, is_pool_readout, &ReadoutParameters::readout)),
      engine_(columns_of_engine(settings.readouts)),
      scale_(settings.sensor.integration_time_s, settings.sensor.np, settings.sensor.pulse_fwhm_s) {
  settings.validate();
}

RunIdentity AccuracyBench::evaluation_run(std::uint64_t seed, std::size_t point, std::size_t batch) {
  return run_identity(seed, Use::kEvaluation, point, batch);
}

AccuracyBench::Batch AccuracyBench::measure(double distance_m, int frames, const RunIdentity& identity,
                                            const std::vector<bool>& active) const {
  const auto make_source = [&](const IndependentPixels& pixels) {
    const TargetMap targets = pixels.targets({.depth_m = distance_m, .reflectivity = settings_.reflectivity});
    return settings_.make_source(settings_.sensor, targets, settings_.klux, identity.seed, identity.frame);
  };
  const IndependentPixels pixels(settings_.sensor, frames, pooled_);
  const std::unique_ptr<StreamSource> source = make_source(pixels);
  // In a map of their own: a wider one has other photons.
  const IndependentPixels engines(settings_.sensor, frames, true, engine_);
  const std::unique_ptr<StreamSource> source_of_engines = engine_ > 1 ? make_source(engines) : nullptr;
  Batch batch(estimators_.size());
  for (std::size_t e = 0; e < batch.size(); ++e) {
    if (active[e]) {
      batch[e].resize(static_cast<std::size_t>(frames));
    }
  }
  if (settings_.run.rtl()) {
    for (std::size_t e = 0; e < batch.size(); ++e) {
      if (active[e] && estimators_[e].readout) {
        read_rtl(*source, pixels, *estimators_[e].readout, batch[e]);
      }
    }
  }
  parallel_for(static_cast<std::size_t>(pixels.columns), settings_.run.threads, [&](std::size_t column) {
    const ColumnStream stream = source->column(pixels.column(static_cast<int>(column)));
    const ColumnStream whole = pooled_ ? pixels.whole_column(stream) : ColumnStream();
    const ColumnStream counted = pixels.counted_rows(stream);
    const std::size_t first = column * static_cast<std::size_t>(pixels.rows);
    for (std::size_t e = 0; e < batch.size(); ++e) {
      const Estimator& estimator = estimators_[e];
      if (!active[e] || (settings_.run.rtl() && estimator.readout)) {
        continue;
      }
      const bool pool = estimator.readout && is_pool_readout(estimator.readout->readout);
      const std::vector<Measurement> read =
          pool && uses_other_columns(*estimator.readout)
              ? read_engine(*source_of_engines, engines, static_cast<int>(column), *estimator.readout)
              : read_model(pool ? whole : counted, estimator, distance_m);
      const auto begin = read.begin() + (pool ? pixels.first_row : 0);
      std::copy_n(begin, pixels.rows, batch[e].begin() + static_cast<std::ptrdiff_t>(first));
    }
  });
  return batch;
}

void AccuracyBench::read_rtl(const StreamSource& source, const IndependentPixels& pixels,
                             const ReadoutParameters& parameters,
                             std::vector<Measurement>& measurements) const {
  const ReadoutRun run = run_readout(source, parameters, settings_.run,
                                     Region::whole(source.columns(), source.rows()), settings_.command);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const int index = static_cast<int>(i);
    const auto row = static_cast<std::size_t>(pixels.row(index % pixels.rows));
    const auto column = static_cast<std::size_t>(pixels.column(index / pixels.rows));
    const auto width = static_cast<std::size_t>(source.columns());
    measurements[i] = to_measurement(run.results[row * width + column], parameters.fraction_bits);
  }
}

std::vector<Measurement> AccuracyBench::read_engine(const StreamSource& source,
                                                    const IndependentPixels& pixels, int index,
                                                    const ReadoutParameters& readout) const {
  ColumnStream stream;
  const std::vector<std::vector<PixelResult>> results = make_readout_model(readout)->run_columns(
      pixels.engine,
      [&](int place) -> const ColumnStream& {
        return stream = pixels.whole_column(source.column(pixels.column(index, place)));
      },
      settings_.sensor.acquisitions);
  std::vector<Measurement> measurements;
  for (const PixelResult& result : results[static_cast<std::size_t>(pixels.engine / 2)]) {
    measurements.push_back(to_measurement(result, readout.fraction_bits));
  }
  return measurements;
}

std::vector<Measurement> AccuracyBench::read_model(const ColumnStream& stream, const Estimator& estimator,
                                                   double distance_m) const {
  std::vector<Measurement> measurements;
  if (estimator.readout) {
    for (const PixelResult& result :
         make_readout_model(*estimator.readout)->run_column(stream, settings_.sensor.acquisitions)) {
      measurements.push_back(to_measurement(result, estimator.readout->fraction_bits));
    }
    return measurements;
  }
  MatchedFilter filter(matched_to(settings_.sensor, stream_rates(distance_m)));
  for (int row = 0; row < stream.rows(); ++row) {
    const MatchedFilter::Result result = filter.estimate(stream.row(row));
    measurements.push_back({result.position, result.score});
  }
  return measurements;
}

std::vector<std::vector<TargetRun>> AccuracyBench::calibration_runs(std::span<const double> distances,
                                                                    Progress* progress) const {
  const std::vector<bool> all(estimators_.size(), true);
  std::vector<std::vector<TargetRun>> runs(estimators_.size());
  for (const double distance : distances) {
    const RunIdentity identity = run_identity(settings_.calibration_seed, Use::kCalibration,
                                              calibration_index(settings_, distance), 0);
    Batch batch = measure(distance, settings_.calibration_frames, identity, all);
    for (std::size_t e = 0; e < estimators_.size(); ++e) {
      runs[e].push_back({identity, distance, std::move(batch[e])});
    }
    if (progress != nullptr) {
      progress->advance();
    }
  }
  return runs;
}

RangeConverter AccuracyBench::converter(std::size_t estimator, std::span<const TargetRun> runs) const {
  const std::optional<ReadoutParameters>& readout = estimators_[estimator].readout;
  return RangeConverter::calibrate(runs, readout ? std::ldexp(1.0, -readout->fraction_bits) : 0.0);
}

MeasuredDistances AccuracyBench::before_table(std::span<const Measurement> measurements) const {
  MeasuredDistances measured{{}, {scale_.depth(0.0), scale_.depth(std::ldexp(1.0, settings_.sensor.np))}};
  measured.distances_m.reserve(measurements.size());
  for (const Measurement& measurement : measurements) {
    measured.distances_m.push_back(scale_.depth(measurement.position));
  }
  return measured;
}

MeasuredDistances AccuracyBench::after_table(const RangeConverter& converter, const TargetRun& run) const {
  return {converter.evaluate(run),
          {converter.distance(0.0), converter.distance(std::ldexp(1.0, settings_.sensor.np))}};
}

// Mean events that a stream of the sensor holds, binning included.
PixelRates AccuracyBench::stream_rates(double distance_m) const {
  const SensorModel& sensor = settings_.sensor;
  const double pixels = sensor.binning * sensor.binning;
  return {.background = pixels * sensor.background_events(settings_.klux, settings_.reflectivity),
          .signal = pixels * sensor.signal_events(distance_m, settings_.reflectivity),
          .centre_bins = arrival_centre_s(distance_m, sensor.pulse_fwhm_s) / sensor.time_resolution_s()};
}

double AccuracyBench::cramer_rao_m(double distance_m) const {
  return scale_.bin_depth() * cramer_rao_bound(pulse_observation(settings_.sensor, stream_rates(distance_m)));
}

std::unique_ptr<StreamSource> make_exact_source(const SensorModel& sensor, const TargetMap& targets,
                                                double klux, std::uint64_t seed, std::uint32_t frame) {
  return std::make_unique<PhotonSource>(sensor, targets, klux, seed, frame);
}

namespace {

ColumnStream picked_rows(const ColumnStream& stream, int first, int count, int pitch) {
  ColumnStream picked;
  for (int i = 0; i < count; ++i) {
    picked.append_row(stream.row(first + pitch * i));
  }
  return picked;
}

}  // namespace

IndependentPixels::IndependentPixels(const SensorModel& sensor, int frames, bool pooled, int engine_columns)
    : rows(pooled ? 1 : std::min(frames, kArrayRows)),
      pitch(sensor.coincidence_window_s ? 3 * sensor.binning : sensor.binning),
      // With coincidence, the block in the middle: its neighbours belong to nobody else.
      offset(sensor.coincidence_window_s ? sensor.binning : 0),
      engine(engine_columns) {
  while (frames % rows != 0) {
    --rows;
  }
  columns = frames / rows;
  height = pooled ? kArrayRows : rows;
  first_row = pooled ? kArrayRows / 2 : 0;
}

TargetMap IndependentPixels::targets(PixelTarget target) const {
  return {pitch * columns * engine, pitch * height, target};
}

ColumnStream IndependentPixels::whole_column(const ColumnStream& stream) const {
  return picked_rows(stream, offset, height, pitch);
}

ColumnStream IndependentPixels::counted_rows(const ColumnStream& stream) const {
  return picked_rows(stream, row(0), rows, pitch);
}

}  // namespace dtof
