// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/hostile_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "common/engine_frame.hpp"
#include "dtof/analytic/pulse_match.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/frame/empty_frame.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/readout/pool_template.hpp"
#include "dtof/readout/pooled_matched_filter.hpp"
#include "dtof/report/table.hpp"
#include "dtof/sensor/condition.hpp"

namespace dtof {
namespace {

constexpr int kCalibrationPixels = 32;  // of each distance
constexpr double kTypicalDistance = 3.0;
constexpr double kStepsPerScore = 8.0;
constexpr double kThree = 0.03;
constexpr double kTen = 0.10;
constexpr std::array<const char*, 2> kReferences = {"matchedfilter", "pooledmatchedfilter"};
constexpr std::array<const char*, 4> kOutcomes = {"within_3", "within_10", "beyond", "sky"};
// Seeds of the sky frames that set the thresholds: none of a scene's.
constexpr std::uint64_t kSkySeeds = 1'000'000;

/// Mean events of each bin that surroundings alone send back to a pixel in an acquisition
/// (frame/empty_frame.hpp).
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

/// Both references of one column. A measurement's confidence is the score. `returns`: what they are told; may
/// be empty.
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

/// Look-up tables of the estimators.
std::vector<RangeConverter> fit_tables(const HostileSettings& settings, double klux) {
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

Outcome outcome_of(const PixelTarget& target, double metres) {
  if (!target.returns_signal()) {
    return Outcome::kSky;
  }
  const double error = std::abs(metres - target.depth_m);
  return error <= kThree * target.depth_m ? Outcome::kWithin3
         : error <= kTen * target.depth_m ? Outcome::kWithin10
                                          : Outcome::kBeyond;
}

/// What is read, with a look-up table of each and of the two references behind them; told of `empty`, if that
/// is not empty.
struct Estimators {
  std::vector<ReadoutParameters> readouts;
  std::vector<std::string> names;
  std::vector<RangeConverter> tables;
  std::vector<double> returns;
};

/// Adds a frame's pixels to each estimator's counts.
void count_frame(const Estimators& estimators, const PhotonSource& source,
                 std::vector<HostileCounts>& counts) {
  const SensorModel& sensor = source.model();
  const std::vector<EngineResults> results = read_engine(source, estimators.readouts);
  const std::size_t readouts = estimators.readouts.size();
  for (int column = 0; column < engine_columns_judged(); ++column) {
    const auto references = read_references(source, column, source.column(column), estimators.returns);
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
        counts[e].add(outcome_of(target, estimators.tables[e].distance(measured.position - skew)),
                      static_cast<int>(confidence));
      }
    }
  }
}

SensorModel sensor_under(const HostileSettings& settings, const std::string& condition) {
  return condition == kClear ? settings.sensor : under_condition(settings.sensor, condition);
}

using Tables = std::function<const std::vector<RangeConverter>&(double klux)>;

/// Those that can be told of what surrounds `sensor`, told.
Estimators told_of(const HostileSettings& settings, const SensorModel& sensor,
                   const std::vector<RangeConverter>& tables) {
  Estimators told{.readouts = {}, .names = told_estimators(settings), .tables = {}, .returns = {}};
  const std::vector<ColumnStream> empty = empty_columns(sensor, settings.seed);
  told.returns = mean_returns(empty, sensor);
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    if (is_pool_readout(settings.readouts[r].readout)) {
      told.readouts.push_back(settings.readouts[r]);
      told.readouts.back().pool.coarse_template =
          measured_template(empty, sensor.acquisitions, settings.readouts[r]);
      told.tables.push_back(tables[r]);
    }
  }
  told.tables.insert(told.tables.end(), tables.end() - kReferences.size(), tables.end());
  return told;
}

/// Each estimator's counts of `maps`, by seed.
HostileReadouts measure(const HostileSettings& settings, const Estimators& estimators,
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
      for (std::size_t outcome = 0; outcome < kOutcomes.size(); ++outcome) {
        for (const auto& [confidence, pixels] : counts[index][e].by_confidence.at(outcome)) {
          own[index % seeds].by_confidence.at(outcome)[confidence] += pixels;
        }
      }
    }
  }
  return readouts;
}

void store_cell(const std::filesystem::path& file, const HostileReadouts& readouts) {
  Table table({"readout", "seed", "outcome", "confidence", "pixels"});
  for (const auto& [name, seeds] : readouts) {
    for (std::size_t seed = 0; seed < seeds.size(); ++seed) {
      for (std::size_t outcome = 0; outcome < kOutcomes.size(); ++outcome) {
        for (const auto& [confidence, pixels] : seeds[seed].by_confidence.at(outcome)) {
          table.add({name, fmt::format("{}", seed), fmt::format("{}", outcome), fmt::format("{}", confidence),
                     fmt::format("{}", pixels)});
        }
      }
    }
  }
  write_file(file, table.csv());
}

HostileReadouts stored_cell(const std::filesystem::path& file, int seeds) {
  const CsvTable table(file);
  const std::vector<std::string> names = table.texts("readout");
  const std::vector<double> seed = table.column("seed");
  const std::vector<double> outcome = table.column("outcome");
  const std::vector<double> confidence = table.column("confidence");
  const std::vector<double> pixels = table.column("pixels");
  HostileReadouts readouts;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<HostileCounts>& own = readouts[names[i]];
    own.resize(static_cast<std::size_t>(seeds));
    own.at(static_cast<std::size_t>(seed[i]))
        .by_confidence.at(static_cast<std::size_t>(outcome[i]))[static_cast<int>(confidence[i])] =
        static_cast<std::uint64_t>(pixels[i]);
  }
  return readouts;
}

void validate(const HostileSettings& settings) {
  if (settings.readouts.empty() || settings.klux.empty() || settings.scenes.empty()) {
    throw InputError("hostile scenes: needs a read-out, a light and a scene");
  }
  if (std::ranges::find(settings.conditions, kClear) == settings.conditions.end()) {
    throw InputError(
        "hostile scenes: what a condition costs is told beside the condition \"clear\", which is missing");
  }
  if (settings.seeds < 2) {
    throw InputError(
        fmt::format("hostile scenes: an interval needs at least 2 seeds, not {}", settings.seeds));
  }
  // Written so that a NaN fails.
  if (!(settings.false_alarms > 0.0 && settings.false_alarms < 1.0)) {
    throw InputError(
        fmt::format("hostile scenes: the share of false alarms must be above 0 and below 1, not {}",
                    settings.false_alarms));
  }
  if (settings.sensor.columns < engine_columns_read() || settings.sensor.rows < settings.rows ||
      settings.rows < 1) {
    throw InputError(
        fmt::format("hostile scenes: {} rows of {} columns are read, but the sensor has {} rows of {}",
                    settings.rows, engine_columns_read(), settings.sensor.rows, settings.sensor.columns));
  }
  if (settings.sensor.binning != 1 || settings.sensor.coincidence_window_s) {
    throw InputError("hostile scenes: binning and coincidence would look beyond the pixels that are read");
  }
}

Estimate share_of(const std::vector<HostileCounts>& seeds,
                  const std::function<std::uint64_t(const HostileCounts&)>& part,
                  const std::function<std::uint64_t(const HostileCounts&)>& whole) {
  std::vector<double> shares;
  for (const HostileCounts& counts : seeds) {
    shares.push_back(static_cast<double>(part(counts)) / static_cast<double>(whole(counts)));
  }
  return estimate_share_of_frames(shares, whole(seeds.front()));
}

}  // namespace

std::uint64_t HostileCounts::count(Outcome outcome, int least_confidence) const {
  return count_from(by_confidence.at(static_cast<std::size_t>(outcome)), least_confidence);
}

std::uint64_t HostileCounts::targets() const {
  return count(Outcome::kWithin3) + count(Outcome::kWithin10) + count(Outcome::kBeyond);
}

std::vector<std::string> hostile_estimators(const HostileSettings& settings) {
  std::vector<std::string> names;
  for (const ReadoutParameters& readout : settings.readouts) {
    names.emplace_back(readout_name(readout.readout));
  }
  names.insert(names.end(), kReferences.begin(), kReferences.end());
  return names;
}

std::vector<std::string> told_estimators(const HostileSettings& settings) {
  std::vector<std::string> names;
  for (const ReadoutParameters& readout : settings.readouts) {
    if (is_pool_readout(readout.readout)) {
      names.emplace_back(readout_name(readout.readout));
    }
  }
  names.insert(names.end(), kReferences.begin(), kReferences.end());
  return names;
}

std::vector<std::string> told_conditions(const HostileSettings& settings) {
  std::vector<std::string> names;
  for (const std::string& condition : settings.conditions) {
    if (has_own_light(sensor_under(settings, condition))) {
      names.push_back(condition);
    }
  }
  return names;
}

std::string hostile_title(const std::string& estimator) {
  if (estimator == kReferences[0]) {
    return "matched filter";
  }
  if (estimator == kReferences[1]) {
    return "pooled matched filter";
  }
  return std::string(readout_title(parse_readout(estimator)));
}

int least_confidence(const std::vector<std::vector<HostileCounts>>& skies, double share) {
  int least = 0;
  for (const std::vector<HostileCounts>& seeds : skies) {
    ConfidenceCounts sum;
    for (const HostileCounts& counts : seeds) {
      for (const auto& [confidence, count] :
           counts.by_confidence.at(static_cast<std::size_t>(Outcome::kSky))) {
        sum[confidence] += count;
      }
    }
    least = std::max(least, lowest_threshold(sum, share));
  }
  return least;
}

HostileScenes run_hostile_scenes(const HostileSettings& settings) {
  validate(settings);
  for (const std::string& condition : settings.conditions) {
    (void)sensor_under(settings, condition);  // refuses unknown ones before anything is measured
  }
  create_output_folder(settings.store);
  std::map<double, std::vector<RangeConverter>> fitted;
  const Tables tables = [&](double klux) -> const std::vector<RangeConverter>& {
    const auto found = fitted.find(klux);
    return found != fitted.end() ? found->second
                                 : fitted.emplace(klux, fit_tables(settings, klux)).first->second;
  };
  std::vector<TargetMap> scenes;
  for (const Scene scene : settings.scenes) {
    scenes.push_back(middle_of(scene, settings.sensor, settings.rows));
  }
  // As bright as a surface of the sensor's reflectivity, as the sky of the scene is.
  const std::vector<TargetMap> sky = {
      TargetMap(engine_columns_read(), settings.rows, {0.0, settings.sensor.default_reflectivity})};
  const std::vector<std::string> told = told_conditions(settings);
  Progress progress("hostile scenes", (settings.conditions.size() + told.size() + 1) * settings.klux.size());
  const auto stored_or = [&](const std::string& name, double klux, const auto& make) {
    const std::filesystem::path file = settings.store / fmt::format("{}_{:g}.csv", name, klux);
    if (!std::filesystem::exists(file)) {
      store_cell(file, make());
    }
    progress.advance(1);
    return stored_cell(file, settings.seeds);
  };
  HostileScenes study;
  std::map<std::string, std::vector<std::vector<HostileCounts>>> skies;
  for (const double klux : settings.klux) {
    const auto all = [&] {
      return Estimators{.readouts = settings.readouts,
                        .names = hostile_estimators(settings),
                        .tables = tables(klux),
                        .returns = {}};
    };
    const HostileReadouts readouts = stored_or("only-sky", klux, [&] {
      return measure(settings, all(), settings.sensor, klux, sky, settings.seed + kSkySeeds);
    });
    for (const auto& [name, seeds] : readouts) {
      skies[name].push_back(seeds);
    }
    for (const std::string& condition : settings.conditions) {
      study.cells[{condition, klux}] = stored_or(condition, klux, [&] {
        return measure(settings, all(), sensor_under(settings, condition), klux, scenes, settings.seed);
      });
    }
    for (const std::string& condition : told) {
      study.told[{condition, klux}] = stored_or("told-" + condition, klux, [&] {
        const SensorModel sensor = sensor_under(settings, condition);
        return measure(settings, told_of(settings, sensor, tables(klux)), sensor, klux, scenes,
                       settings.seed);
      });
    }
  }
  for (const auto& [name, lights] : skies) {
    study.thresholds[name] = least_confidence(lights, settings.false_alarms);
  }
  return study;
}

Estimate share_above(const std::vector<HostileCounts>& seeds, int percent) {
  return share_of(
      seeds,
      [percent](const HostileCounts& counts) {
        return counts.count(Outcome::kBeyond) + (percent < 10 ? counts.count(Outcome::kWithin10) : 0);
      },
      [](const HostileCounts& counts) { return counts.targets(); });
}

Estimate share_detected(const std::vector<HostileCounts>& seeds, int threshold) {
  return share_of(
      seeds, [threshold](const HostileCounts& counts) { return counts.count(Outcome::kWithin3, threshold); },
      [](const HostileCounts& counts) { return counts.targets(); });
}

std::optional<Estimate> share_of_false_alarms(const std::vector<HostileCounts>& seeds, int threshold) {
  if (seeds.front().count(Outcome::kSky) == 0) {
    return std::nullopt;
  }
  return share_of(
      seeds, [threshold](const HostileCounts& counts) { return counts.count(Outcome::kSky, threshold); },
      [](const HostileCounts& counts) { return counts.count(Outcome::kSky); });
}

}  // namespace dtof
