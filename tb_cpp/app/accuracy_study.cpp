// SPDX-License-Identifier: Apache-2.0
#include "app/accuracy_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include "analytic/pulse_match.hpp"
#include "app/readout_run.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/physical_constants.hpp"
#include "core/progress.hpp"
#include "host/range_converter.hpp"
#include "metrics/cramer_rao.hpp"
#include "metrics/depth.hpp"
#include "photon/photon_source.hpp"
#include "photon/physics.hpp"
#include "readout/matched_filter.hpp"
#include "readout/model.hpp"

namespace dtof {
namespace {

constexpr double kOutlier = 0.10;
constexpr double kRequirement = 0.03;

struct Estimator {
  std::string name;
  std::string title;
  std::optional<ReadoutParameters> readout;  // none: the matched filter

  [[nodiscard]] double code_step() const { return readout ? std::ldexp(1.0, -readout->fraction_bits) : 0.0; }
};

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
// whatever the user's seed.
enum class Use : std::uint32_t { kEvaluation = 0, kCalibration = 1 };

RunIdentity run_identity(const StudySettings& settings, Use use, std::size_t point, std::size_t batch) {
  constexpr std::size_t kPoints = 1U << 14U;
  constexpr std::size_t kBatches = 1U << 17U;
  if (point >= kPoints || batch >= kBatches) {
    throw InputError(
        fmt::format("accuracy: more than {} distances or {} batches of frames", kPoints, kBatches));
  }
  return {settings.run.seed,
          static_cast<std::uint32_t>((static_cast<std::size_t>(use) << 31U) | (batch << 14U) | point)};
}

// Mean events a stream of the sensor holds, binning included.
PixelRates stream_rates(const SensorModel& sensor, double klux, double distance_m, double reflectivity) {
  const double pixels = sensor.binning * sensor.binning;
  return {.background = pixels * sensor.background_events(klux, reflectivity),
          .signal = pixels * sensor.signal_events(distance_m, reflectivity),
          .centre_bins = arrival_centre_s(distance_m, sensor.pulse_fwhm_s) / sensor.time_resolution_s()};
}

class Sweep {
 public:
  explicit Sweep(const StudySettings& settings)
      : settings_(settings),
        estimators_(make_estimators(settings)),
        scale_(settings.sensor.integration_time_s, settings.sensor.np, settings.sensor.pulse_fwhm_s) {}

  AccuracyStudy run() {
    std::vector<double> distances = settings_.distances_m;
    std::ranges::sort(distances);
    distances.erase(std::unique(distances.begin(), distances.end()), distances.end());
    const std::vector<double> calibration_distances =
        settings_.lookup_table ? calibration_sweep(distances) : std::vector<double>();
    Progress progress(fmt::format("{:g} klux", settings_.klux),
                      distances.size() + calibration_distances.size());
    AccuracyStudy study;
    calibrate(calibration_distances, progress, study);
    std::vector<std::vector<TargetRun>> runs(estimators_.size());
    std::vector<std::vector<AccuracyPoint>> points(estimators_.size());
    for (std::size_t d = 0; d < distances.size(); ++d) {
      evaluate(distances[d], d, runs, points);
      progress.advance();
    }
    for (std::size_t e = 0; e < estimators_.size(); ++e) {
      add_slopes(runs[e], points[e]);
      std::ranges::move(points[e], std::back_inserter(study.points));
    }
    return study;
  }

 private:
  using Batch = std::vector<std::vector<Measurement>>;  // estimator, pixel

  [[nodiscard]] std::vector<double> calibration_sweep(const std::vector<double>& distances) const {
    const SensorModel& sensor = settings_.sensor;
    const double farthest = 0.5 * kSpeedOfLight * (sensor.integration_time_s - sensor.pulse_fwhm_s);
    const double step = settings_.calibration_step_m;
    if (!std::isfinite(step) || step <= 0.0) {
      throw InputError(fmt::format("accuracy: the calibration step is {} m, but must be above 0", step));
    }
    // Beyond both ends, so that no evaluated distance is extrapolated.
    const double begin = std::max(0.5 * distances.front(), distances.front() - 4.0 * step);
    const double end = std::max(std::min(distances.back() + 4.0 * step, farthest), begin + 2.0 * step);
    std::vector<double> sweep;
    for (int i = 0; begin + i * step <= end; ++i) {
      sweep.push_back(begin + i * step);
    }
    return sweep;
  }

  [[nodiscard]] Batch measure(double distance_m, int frames, const RunIdentity& identity,
                              const std::vector<bool>& active) const {
    const IndependentPixels pixels(settings_.sensor, frames);
    const TargetMap targets = pixels.targets({.depth_m = distance_m, .reflectivity = settings_.reflectivity});
    const std::unique_ptr<StreamSource> source =
        settings_.make_source(settings_.sensor, targets, settings_.klux, identity.seed, identity.frame);
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
      const ColumnStream whole = source->column(pixels.column(static_cast<int>(column)));
      const ColumnStream picked = pixels.pitch == 1 ? ColumnStream() : pixels.rows_of(whole);
      const ColumnStream& stream = pixels.pitch == 1 ? whole : picked;
      const std::size_t first = column * static_cast<std::size_t>(pixels.rows);
      for (std::size_t e = 0; e < batch.size(); ++e) {
        if (active[e] && !(settings_.run.rtl() && estimators_[e].readout)) {
          read_model(stream, estimators_[e], distance_m,
                     std::span(batch[e]).subspan(first, static_cast<std::size_t>(pixels.rows)));
        }
      }
    });
    return batch;
  }

  void read_rtl(const StreamSource& source, const IndependentPixels& pixels,
                const ReadoutParameters& parameters, std::vector<Measurement>& measurements) const {
    const ReadoutRun run = run_readout(source, parameters, settings_.run,
                                       Region::whole(source.columns(), source.rows()), settings_.command);
    for (std::size_t i = 0; i < measurements.size(); ++i) {
      const int index = static_cast<int>(i);
      const auto row = static_cast<std::size_t>(pixels.column(index % pixels.rows));
      const auto column = static_cast<std::size_t>(pixels.column(index / pixels.rows));
      const auto width = static_cast<std::size_t>(source.columns());
      measurements[i] = to_measurement(run.results[row * width + column], parameters.fraction_bits);
    }
  }

  void read_model(const ColumnStream& stream, const Estimator& estimator, double distance_m,
                  std::span<Measurement> measurements) const {
    if (estimator.readout) {
      const std::vector<PixelResult> results =
          make_readout_model(*estimator.readout)->run_column(stream, settings_.sensor.acquisitions);
      std::ranges::transform(results, measurements.begin(), [&](const PixelResult& result) {
        return to_measurement(result, estimator.readout->fraction_bits);
      });
      return;
    }
    MatchedFilter filter(matched_to(settings_.sensor, stream_rates(settings_.sensor, settings_.klux,
                                                                   distance_m, settings_.reflectivity)));
    for (int row = 0; row < stream.rows(); ++row) {
      const MatchedFilter::Result result = filter.estimate(stream.row(row));
      measurements[static_cast<std::size_t>(row)] = {result.position, result.score};
    }
  }

  void calibrate(const std::vector<double>& distances, Progress& progress, AccuracyStudy& study) {
    if (distances.empty()) {
      return;
    }
    const std::vector<bool> all(estimators_.size(), true);
    std::vector<std::vector<TargetRun>> runs(estimators_.size());
    for (std::size_t d = 0; d < distances.size(); ++d) {
      const RunIdentity identity = run_identity(settings_, Use::kCalibration, d, 0);
      Batch batch = measure(distances[d], settings_.calibration_frames, identity, all);
      for (std::size_t e = 0; e < estimators_.size(); ++e) {
        runs[e].push_back({identity, distances[d], std::move(batch[e])});
      }
      progress.advance();
    }
    for (std::size_t e = 0; e < estimators_.size(); ++e) {
      converters_.push_back(RangeConverter::calibrate(runs[e], estimators_[e].code_step()));
      if (settings_.rejection && !converters_[e].choose_least_confidence(runs[e], *settings_.rejection)) {
        study.without_rejection.push_back(estimators_[e].title);
      }
    }
  }

  void evaluate(double distance_m, std::size_t index, std::vector<std::vector<TargetRun>>& runs,
                std::vector<std::vector<AccuracyPoint>>& points) const {
    std::vector<bool> active(estimators_.size(), true);
    for (std::vector<TargetRun>& run : runs) {
      run.push_back({run_identity(settings_, Use::kEvaluation, index, 0), distance_m, {}});
    }
    for (std::vector<AccuracyPoint>& point : points) {
      point.emplace_back();
    }
    int total = 0;
    // Each batch doubles the frames: few looks at the interval, so that stopping hardly biases it.
    for (std::size_t batch = 0; std::ranges::find(active, true) != active.end(); ++batch) {
      const int wanted = batch == 0 ? settings_.frames : std::min(total, settings_.most_frames - total);
      const Batch added =
          measure(distance_m, wanted, run_identity(settings_, Use::kEvaluation, index, batch), active);
      total += wanted;
      parallel_for(estimators_.size(), settings_.run.threads, [&](std::size_t e) {
        if (active[e]) {
          std::vector<Measurement>& measurements = runs[e][index].measurements;
          measurements.insert(measurements.end(), added[e].begin(), added[e].end());
          points[e][index] = summarise(e, runs[e][index]);
        }
      });
      for (std::size_t e = 0; e < estimators_.size(); ++e) {
        active[e] = active[e] && !points[e][index].precision_reached && total < settings_.most_frames;
      }
    }
  }

  [[nodiscard]] std::vector<double> depths(const TargetRun& run) const {
    std::vector<double> depths;
    depths.reserve(run.measurements.size());
    for (const Measurement& measurement : run.measurements) {
      depths.push_back(scale_.depth(measurement.position));
    }
    return depths;
  }

  [[nodiscard]] AccuracyPoint summarise(std::size_t e, const TargetRun& run) const {
    const double truth = run.distance_m;
    const std::vector<double> before = depths(run);
    const std::vector<double> after = converters_.empty() ? before : converters_[e].evaluate(run);
    std::vector<double> relative;
    std::vector<double> errors_before;
    std::vector<double> errors;
    std::uint64_t above_3_percent = 0;
    std::uint64_t outliers = 0;
    std::uint64_t accepted = 0;
    std::uint64_t outliers_kept = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      errors_before.push_back(before[i] - truth);
      relative.push_back(std::abs(before[i] - truth) / truth);
      errors.push_back(after[i] - truth);
      const bool outlier = std::abs(after[i] - truth) > kOutlier * truth;
      above_3_percent += std::abs(after[i] - truth) > kRequirement * truth ? 1 : 0;
      outliers += outlier ? 1 : 0;
      const bool kept =
          converters_.empty() || run.measurements[i].confidence >= converters_[e].least_confidence();
      accepted += kept ? 1 : 0;
      outliers_kept += kept && outlier ? 1 : 0;
    }
    const std::uint64_t count = before.size();
    AccuracyPoint point{};
    point.estimator = estimators_[e].name;
    point.title = estimators_[e].title;
    point.klux = settings_.klux;
    point.distance_m = truth;
    point.frames = count;
    point.relative_precision = estimate_standard_deviation(relative);
    point.bias_m = estimate_mean(errors_before);
    point.rmse_m = estimate_root_mean_square(errors);
    point.above_3_percent = estimate_share(above_3_percent, count);
    point.outlier_rate = estimate_share(outliers, count);
    point.cramer_rao_m =
        scale_.bin_depth() *
        cramer_rao_bound(pulse_observation(
            settings_.sensor, stream_rates(settings_.sensor, settings_.klux, truth, settings_.reflectivity)));
    point.efficiency = reciprocal(point.cramer_rao_m, point.rmse_m);
    if (settings_.rejection) {
      point.accepted = estimate_share(accepted, count);
      if (accepted > 0) {
        point.outliers_kept = estimate_share(outliers_kept, accepted);
      }
    }
    point.precision_reached =
        !settings_.precision || (point.relative_precision.relative_half_width() <= *settings_.precision &&
                                 point.rmse_m.relative_half_width() <= *settings_.precision);
    return point;
  }

  void add_slopes(const std::vector<TargetRun>& runs, std::vector<AccuracyPoint>& points) const {
    for (std::size_t d = 0; d < points.size() && points.size() > 1; ++d) {
      const std::size_t before = d == 0 ? 0 : d - 1;
      const std::size_t after = std::min(d + 1, points.size() - 1);
      points[d].slope = estimate_slope(depths(runs[before]), depths(runs[after]),
                                       points[after].distance_m - points[before].distance_m);
    }
  }

  const StudySettings& settings_;
  std::vector<Estimator> estimators_;
  DepthScale scale_;
  std::vector<RangeConverter> converters_;  // of each estimator; empty without look-up table
};

void validate(const StudySettings& settings) {
  constexpr int kLeastFrames = 4;  // a standard deviation's interval needs them
  if (settings.frames < kLeastFrames || settings.calibration_frames < 1) {
    throw InputError(
        fmt::format("accuracy: needs at least {} frames a distance and 1 to calibrate, not {} and {}",
                    kLeastFrames, settings.frames, settings.calibration_frames));
  }
  if (settings.precision && !(*settings.precision > 0.0)) {
    throw InputError(fmt::format("accuracy: the precision must be above 0, not {}", *settings.precision));
  }
  if (settings.distances_m.empty() || (settings.readouts.empty() && !settings.matched_filter)) {
    throw InputError("accuracy: needs at least one distance and one read-out");
  }
  for (const double distance : settings.distances_m) {
    if (!std::isfinite(distance) || distance <= 0.0) {
      throw InputError(fmt::format("accuracy: distances must be finite and above 0, not {} m", distance));
    }
  }
  if (settings.rejection && !settings.lookup_table) {
    throw InputError("accuracy: rejection by confidence needs the calibration run");
  }
  for (const ReadoutParameters& readout : settings.readouts) {
    if (readout.np != settings.sensor.np || readout.slots != settings.sensor.slots) {
      throw std::logic_error("accuracy: NP and SLOTS of a read-out and of the sensor differ");
    }
  }
}

}  // namespace

std::unique_ptr<StreamSource> make_exact_source(const SensorModel& sensor, const TargetMap& targets,
                                                double klux, std::uint64_t seed, std::uint32_t frame) {
  return std::make_unique<PhotonSource>(sensor, targets, klux, seed, frame);
}

IndependentPixels::IndependentPixels(const SensorModel& sensor, int frames)
    : rows(std::min(frames, 160)),  // as the thesis's array has, and thus the RTL
      pitch(sensor.coincidence_window_s ? 3 * sensor.binning : sensor.binning),
      // With coincidence, the block in the middle: its neighbours belong to nobody else.
      offset(sensor.coincidence_window_s ? sensor.binning : 0) {
  while (frames % rows != 0) {
    --rows;
  }
  columns = frames / rows;
}

TargetMap IndependentPixels::targets(PixelTarget target) const {
  return {pitch * columns, pitch * rows, target};
}

ColumnStream IndependentPixels::rows_of(const ColumnStream& stream) const {
  ColumnStream picked;
  for (int i = 0; i < rows; ++i) {
    picked.append_row(stream.row(pitch * i + offset));
  }
  return picked;
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

AccuracyStudy run_accuracy_study(const StudySettings& settings) {
  settings.sensor.validate();
  validate(settings);
  return Sweep(settings).run();
}

}  // namespace dtof
