// SPDX-License-Identifier: Apache-2.0
#include "walk_error/walk_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/host/walk_correction.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/model.hpp"

namespace dtof {
namespace {

constexpr int kRows = FlatCalibration::kPixels;
constexpr std::uint32_t kJudgedFrame = scene_frame(0);
constexpr std::uint32_t kCorrectionFrame = scene_frame(1);
constexpr std::uint32_t kLeftFrames = 16;  // beyond the frames above
constexpr double kWalkOutlier = 0.10;
constexpr double kRequirement = 0.03;
constexpr double kLeastFound = 0.5;

bool uses_other_columns(const ReadoutParameters& readout) { return readout.columns_together() > 1; }

/// A column of pixels that all look at one target; where columns depend on each other, the right one of a
/// pair, whose left one has the photons of another frame.
using Measurements = std::vector<std::vector<std::vector<Measurement>>>;  // read-out, column, row

Measurements read(const WalkSettings& settings, std::span<const PixelTarget> columns, std::uint32_t frame) {
  TargetMap targets(static_cast<int>(columns.size()), kRows);
  for (int column = 0; column < targets.columns(); ++column) {
    for (int row = 0; row < kRows; ++row) {
      targets.at(column, row) = columns[static_cast<std::size_t>(column)];
    }
  }
  const PhotonSource source(settings.sensor, targets, settings.klux, settings.seed, frame);
  const PhotonSource lefts = source.at_frame(frame + kLeftFrames);
  const bool paired = std::ranges::any_of(settings.readouts, uses_other_columns);
  Measurements measurements(settings.readouts.size(), std::vector<std::vector<Measurement>>(columns.size()));
  parallel_for(columns.size(), settings.threads, [&](std::size_t column) {
    const int index = static_cast<int>(column);
    const std::array<ColumnStream, 2> pair = {paired ? lefts.column(index) : ColumnStream(),
                                              source.column(index)};
    for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
      const ReadoutParameters& readout = settings.readouts[r];
      const auto model = make_readout_model(readout);
      const std::uint32_t acquisitions = settings.sensor.acquisitions;
      const std::vector<PixelResult> results = uses_other_columns(readout)
                                                   ? model->run_columns(pair, acquisitions).back()
                                                   : model->run_column(pair.back(), acquisitions);
      for (const PixelResult& result : results) {
        measurements[r][column].push_back(to_measurement(result, readout.fraction_bits));
      }
    }
  });
  return measurements;
}

/// Logarithmically spaced, from the smallest to the largest of those judged.
std::vector<double> correction_reflectivities(const WalkSettings& settings) {
  constexpr int kReflectivities = 8;
  const auto [least, most] = std::ranges::minmax(settings.reflectivities);
  std::vector<double> reflectivities(kReflectivities);
  for (std::size_t i = 0; i < reflectivities.size(); ++i) {
    reflectivities[i] = least * std::pow(most / least, static_cast<double>(i) / (kReflectivities - 1));
  }
  return reflectivities;
}

/// Those of the look-up table, to half a metre beyond the farthest that is judged.
std::vector<PixelTarget> correction_targets(const WalkSettings& settings,
                                            const FlatCalibration& calibration) {
  const double farthest = std::ranges::max(settings.distances_m) + 0.5;
  std::vector<PixelTarget> targets;
  for (const double distance : calibration.distances_m()) {
    if (distance <= farthest) {
      for (const double reflectivity : correction_reflectivities(settings)) {
        targets.push_back({distance, reflectivity});
      }
    }
  }
  return targets;
}

/// `columns`: measurements of one target; `table` tells which pixels found it.
WalkErrors errors_of_found(std::span<const std::vector<Measurement>> columns, double truth_m,
                           double found_within_m, const RangeConverter& table,
                           const std::function<double(const Measurement&)>& distance) {
  std::vector<double> means;
  RunningMoments found;
  std::size_t above_3_percent = 0;
  std::size_t above_10_percent = 0;
  std::size_t total = 0;
  for (const std::vector<Measurement>& column : columns) {
    RunningMoments errors;
    for (const Measurement& measurement : column) {
      const double error = distance(measurement) - truth_m;
      above_3_percent += std::abs(error) > kRequirement * truth_m ? 1 : 0;
      above_10_percent += std::abs(error) > kWalkOutlier * truth_m ? 1 : 0;
      if (std::abs(table.distance(measurement.position) - truth_m) <= found_within_m) {
        errors.add(error);
      }
    }
    total += column.size();
    means.push_back(errors.mean());
    found.merge(errors);
  }
  return {estimate_mean(means), std::sqrt(found.mean_square()),
          static_cast<double>(above_3_percent) / static_cast<double>(total),
          static_cast<double>(above_10_percent) / static_cast<double>(total)};
}

/// Shares of pixels of each column that found the target.
std::vector<double> found_shares(std::span<const std::vector<Measurement>> columns, double truth_m,
                                 double found_within_m, const RangeConverter& table) {
  std::vector<double> shares;
  for (const std::vector<Measurement>& column : columns) {
    const auto found = std::ranges::count_if(column, [&](const Measurement& measurement) {
      return std::abs(table.distance(measurement.position) - truth_m) <= found_within_m;
    });
    shares.push_back(static_cast<double>(found) / static_cast<double>(column.size()));
  }
  return shares;
}

void validate(const WalkSettings& settings) {
  constexpr int kFewestColumns = 4;
  if (settings.columns < kFewestColumns) {
    throw InputError(
        fmt::format("walk: needs at least {} columns, not {}", kFewestColumns, settings.columns));
  }
  if (settings.readouts.empty() || settings.reflectivities.size() < 2 || settings.distances_m.empty()) {
    throw InputError("walk: needs a read-out, two reflectivities and a distance");
  }
  for (const double value : settings.reflectivities) {
    if (!std::isfinite(value) || value <= 0.0) {
      throw InputError(fmt::format("walk: a reflectivity must be finite and above 0, not {}", value));
    }
  }
  for (const double value : settings.distances_m) {
    if (!std::isfinite(value) || value <= 0.0) {
      throw InputError(fmt::format("walk: a distance must be finite and above 0, not {} m", value));
    }
  }
  if (settings.sensor.binning != 1 || settings.sensor.coincidence_window_s) {
    throw InputError("walk: binning and coincidence would mix targets that stand side by side");
  }
}

double size(const Estimate& bias) { return std::abs(bias.value); }
double half_width(const Estimate& bias) { return 0.5 * (bias.interval.high - bias.interval.low); }

double rms_bias(const std::vector<WalkPoint>& points, WalkErrors WalkPoint::*errors) {
  RunningMoments moments;
  for (const WalkPoint& point : points) {
    if (point.judged) {
      moments.add((point.*errors).bias_m.value);
    }
  }
  return std::sqrt(moments.mean_square());
}

double rms_walk(const std::vector<WalkPoint>& points, WalkErrors WalkPoint::*errors) {
  std::map<double, std::vector<double>> by_distance;
  for (const WalkPoint& point : points) {
    if (point.judged) {
      by_distance[point.distance_m].push_back((point.*errors).bias_m.value);
    }
  }
  RunningMoments ranges;
  for (const auto& [distance, biases] : by_distance) {
    if (biases.size() >= 2) {
      const auto [lowest, highest] = std::ranges::minmax(biases);
      ranges.add(highest - lowest);
    }
  }
  return std::sqrt(ranges.mean_square());
}

/// Whether |a| is below |b| beyond both intervals.
bool clearly_smaller(const Estimate& a, const Estimate& b) {
  return size(a) + half_width(a) < size(b) - half_width(b);
}

}  // namespace

std::size_t WalkReadout::judged() const {
  return static_cast<std::size_t>(std::ranges::count(points, true, &WalkPoint::judged));
}

double WalkReadout::walk_before_m() const { return rms_walk(points, &WalkPoint::before); }
double WalkReadout::walk_after_m() const { return rms_walk(points, &WalkPoint::after); }
double WalkReadout::rms_bias_before_m() const { return rms_bias(points, &WalkPoint::before); }
double WalkReadout::rms_bias_after_m() const { return rms_bias(points, &WalkPoint::after); }

std::size_t WalkReadout::better() const {
  return static_cast<std::size_t>(std::ranges::count_if(points, [](const WalkPoint& point) {
    return point.judged && clearly_smaller(point.after.bias_m, point.before.bias_m);
  }));
}

std::size_t WalkReadout::worse() const {
  return static_cast<std::size_t>(std::ranges::count_if(points, [](const WalkPoint& point) {
    return point.judged && clearly_smaller(point.before.bias_m, point.after.bias_m);
  }));
}

std::vector<WalkReadout> run_walk_study(const WalkSettings& settings) {
  validate(settings);
  const FlatCalibration calibration(settings.sensor);
  const std::vector<RangeConverter> tables = calibration.fit(
      [&](const TargetMap& targets) {
        return std::make_unique<PhotonSource>(settings.sensor, targets, settings.klux, settings.seed,
                                              FlatCalibration::kFrame);
      },
      settings.readouts, settings.seed, settings.threads);

  const std::vector<PixelTarget> fitted = correction_targets(settings, calibration);
  const Measurements fitting = read(settings, fitted, kCorrectionFrame);

  std::vector<PixelTarget> judged;
  for (const double reflectivity : settings.reflectivities) {
    for (const double distance : settings.distances_m) {
      judged.insert(judged.end(), static_cast<std::size_t>(settings.columns), {distance, reflectivity});
    }
  }
  const Measurements measured = read(settings, judged, kJudgedFrame);

  const double found_within_m = 0.5 * kSpeedOfLight * settings.sensor.pulse_fwhm_s;
  std::vector<WalkReadout> results;
  const auto columns = static_cast<std::size_t>(settings.columns);
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    const ReadoutParameters& readout = settings.readouts[r];
    std::vector<TargetRun> runs;
    double top = 0.0;
    for (std::size_t i = 0; i < fitted.size(); ++i) {
      runs.push_back({{settings.seed, kCorrectionFrame}, fitted[i].depth_m, fitting[r][i]});
      for (const Measurement& measurement : fitting[r][i]) {
        top = std::max(top, measurement.confidence);
      }
    }
    std::size_t at_top = 0;
    for (const TargetRun& run : runs) {
      at_top += static_cast<std::size_t>(std::ranges::count(run.measurements, top, &Measurement::confidence));
    }
    const WalkCorrection correction = WalkCorrection::calibrate(runs, tables[r], found_within_m);
    WalkReadout result{std::string(readout_name(readout.readout)),
                       std::string(readout_title(readout.readout)),
                       correction.classes(),
                       static_cast<double>(at_top) / static_cast<double>(fitted.size() * kRows),
                       {}};
    for (std::size_t i = 0; i < judged.size(); i += columns) {
      const std::span own(&measured[r][i], columns);
      const double truth = judged[i].depth_m;
      const std::vector<double> found = found_shares(own, truth, found_within_m, tables[r]);
      const auto errors = [&](const std::function<double(const Measurement&)>& distance) {
        return errors_of_found(own, truth, found_within_m, tables[r], distance);
      };
      result.points.push_back(
          {.reflectivity = judged[i].reflectivity,
           .distance_m = truth,
           .found = std::accumulate(found.begin(), found.end(), 0.0) / static_cast<double>(found.size()),
           .judged = std::ranges::min(found) >= kLeastFound,
           .before = errors([&](const Measurement& m) { return tables[r].distance(m.position); }),
           .after = errors([&](const Measurement& m) { return correction.distance(m); })});
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace dtof
