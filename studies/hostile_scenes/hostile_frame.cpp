// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/hostile_frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "common/engine_frame.hpp"
#include "dtof/analytic/pulse_match.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/pooled_matched_filter.hpp"

namespace dtof {
namespace {

constexpr int kCalibrationPixels = 32;  // of each distance
constexpr double kTypicalDistance = 3.0;
constexpr double kStepsPerScore = 8.0;
constexpr double kThree = 0.03;
constexpr double kTen = 0.10;
constexpr double kNearTarget = 0.3;  // m: a bias is the mean of the errors up to here
constexpr double kMicrometres = 1e6;

/// Both references of one column. A measurement's confidence is the score. `returns`: mean events
/// of a frame without a target, which the references count as background; may be empty.
std::array<std::vector<Measurement>, 2> read_references(const PhotonSource& source, int column,
                                                        const ColumnStream& stream,
                                                        const std::vector<double>& returns = {}) {
  const SensorModel& sensor = source.model();
  const auto bins = (std::size_t{1} << static_cast<unsigned>(sensor.np)) - 1;
  const auto rows = static_cast<std::size_t>(source.rows());
  std::array<std::vector<Measurement>, 2> measurements;
  std::unique_ptr<MatchedFilter> filter;
  double background = -1.0;
  std::vector<std::vector<double>> scores(rows, std::vector<double>(bins, 0.0));
  for (std::size_t row = 0; row < rows; ++row) {
    PixelRates rates = source.rates(column, static_cast<int>(row));
    rates.signal = sensor.signal_events(kTypicalDistance, sensor.default_reflectivity);
    if (!filter || rates.background != background) {
      MatchedFilterParameters parameters = matched_to(sensor, rates);
      parameters.returns = returns;
      filter = std::make_unique<MatchedFilter>(parameters);
      background = rates.background;
    }
    std::ranges::copy(filter->scores(stream.row(static_cast<int>(row))), scores[row].begin());
    const auto peak = std::ranges::max_element(scores[row]);
    const auto bin = static_cast<std::size_t>(peak - scores[row].begin());
    measurements[0].push_back({refined_peak(scores[row], bin), *peak});
  }
  for (const MatchedFilter::Result& result : pool_column(scores)) {
    measurements[1].push_back({result.position, result.score});
  }
  return measurements;
}

/// `truth`: the distance to be right about.
void count_pixel(HostileCounts& counts, const PixelTarget& target, double truth, double metres,
                 int confidence) {
  if (!target.returns_signal()) {
    counts.add(Outcome::kSky, confidence);
    return;
  }
  const double error = metres - truth;
  const double size = std::abs(error);
  counts.add(size <= kThree * truth ? Outcome::kWithin3
             : size <= kTen * truth ? Outcome::kWithin10
                                    : Outcome::kBeyond,
             confidence);
  if (size <= kNearTarget) {
    ++counts.near_target;
    counts.error_um += std::llround(kMicrometres * error);
  }
}

/// Adds a frame's pixels to each estimator's counts.
void count_frame(const Estimators& estimators, const PhotonSource& source,
                 std::vector<HostileCounts>& counts) {
  const SensorModel& sensor = source.model();
  const std::vector<EngineResults> results = read_engine(source, estimators.readouts, estimators.settle);
  const double travelled = travel_of_a_frame(sensor);
  const std::size_t readouts = estimators.readouts.size();
  for (int column = 0; column < engine_columns_judged(); ++column) {
    const auto references = read_references(
        source, column, without_first(source.column(column), estimators.settle), estimators.returns);
    for (int row = 0; row < source.rows(); ++row) {
      const PixelTarget& target = source.targets().at(column, row);
      // The host knows the skew.
      const double skew =
          sensor.surroundings.skew.of_pixel(column, row, source.columns()) / sensor.time_resolution_s();
      const auto place = static_cast<std::size_t>(row);
      for (std::size_t e = 0; e < counts.size(); ++e) {
        const bool reference = e >= readouts;
        const Measurement measured = reference
                                         ? references[e - readouts][place]
                                         : to_measurement(results[e][static_cast<std::size_t>(column)][place],
                                                          estimators.readouts[e].fraction_bits);
        const double confidence =
            std::clamp(measured.confidence * (reference ? kStepsPerScore : 1.0), 0.0, 1e6);
        const double moved = estimators.instants == nullptr
                                 ? 0.0
                                 : travelled * (estimators.instants->at(estimators.names[e], target.depth_m) -
                                                kMiddleOfAFrame);
        count_pixel(counts[e], target, target.depth_m + moved,
                    estimators.tables[e].distance(measured.position - skew), static_cast<int>(confidence));
      }
    }
  }
}

}  // namespace

std::vector<double> mean_returns(const std::vector<ColumnStream>& empty, const SensorModel& sensor) {
  std::vector<double> mean((std::size_t{1} << static_cast<unsigned>(sensor.np)) - 1, 0.0);
  double pixels = 0.0;
  for (const ColumnStream& column : empty) {
    for (int row = 0; row < column.rows(); ++row, ++pixels) {
      for (const Detection& detection : column.row(row)) {
        if (detection.timestamp < mean.size()) {
          mean[detection.timestamp] += 1.0;
        }
      }
    }
  }
  for (double& events : mean) {
    events /= pixels * sensor.acquisitions;
  }
  return mean;
}

double travel_of_a_frame(const SensorModel& sensor) {
  return sensor.surroundings.motion.velocity_m_per_s * sensor.pulse_period() * sensor.acquisitions;
}

std::vector<RangeConverter> fit_hostile_tables(const HostileSettings& settings, double klux) {
  const SensorModel sensor = settings.sensor.as_calibrated();
  const FlatCalibration calibration(sensor, kCalibrationPixels);
  std::vector<RangeConverter> tables = calibration.fit(
      [&](const TargetMap& targets) {
        return std::make_unique<PhotonSource>(sensor, targets, klux, settings.seed, FlatCalibration::kFrame);
      },
      settings.readouts, settings.seed, settings.threads);
  const PhotonSource source(sensor, calibration.targets(), klux, settings.seed, FlatCalibration::kFrame);
  const std::size_t distances = calibration.distances_m().size();
  const auto rows = static_cast<std::size_t>(source.rows());
  std::array<std::vector<Measurement>, 2> all;
  all.fill(std::vector<Measurement>(distances * rows));
  parallel_for(distances, settings.threads, [&](std::size_t distance) {
    const int column = calibration.column(distance);
    const auto own = read_references(source, column, source.column(column));
    for (std::size_t e = 0; e < own.size(); ++e) {
      for (std::size_t row = 0; row < rows; ++row) {
        all[e][row * distances + distance] = own[e][row];
      }
    }
  });
  for (const std::vector<Measurement>& measurements : all) {
    tables.push_back(calibration.fit(measurements, 0.0, settings.seed));
  }
  return tables;
}

HostileReadouts measure_hostile(const HostileSettings& settings, const Estimators& estimators,
                                const SensorModel& sensor, double klux, const std::vector<TargetMap>& maps,
                                std::uint64_t first_seed) {
  const std::vector<std::string>& names = estimators.names;
  const auto seeds = static_cast<std::size_t>(settings.seeds);
  std::vector<std::vector<HostileCounts>> counts(maps.size() * seeds,
                                                 std::vector<HostileCounts>(names.size()));
  parallel_for(counts.size(), settings.threads, [&](std::size_t index) {
    const std::size_t map = index / seeds;
    const PhotonSource source(sensor, maps[map], klux, first_seed + index % seeds,
                              scene_frame(static_cast<std::uint32_t>(map)));
    count_frame(estimators, source, counts[index]);
  });
  HostileReadouts readouts;
  for (std::size_t e = 0; e < names.size(); ++e) {
    std::vector<HostileCounts>& own = readouts[names[e]];
    own.resize(seeds);
    for (std::size_t index = 0; index < counts.size(); ++index) {
      own[index % seeds].near_target += counts[index][e].near_target;
      own[index % seeds].error_um += counts[index][e].error_um;
      for (std::size_t outcome = 0; outcome < counts[index][e].by_confidence.size(); ++outcome) {
        for (const auto& [confidence, pixels] : counts[index][e].by_confidence.at(outcome)) {
          own[index % seeds].by_confidence.at(outcome)[confidence] += pixels;
        }
      }
    }
  }
  return readouts;
}

}  // namespace dtof
