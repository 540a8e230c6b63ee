// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/hostile_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "common/engine_frame.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/frame/empty_frame.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/readout/pool_template.hpp"
#include "dtof/report/table.hpp"
#include "dtof/sensor/condition.hpp"
#include "hostile_scenes/hostile_frame.hpp"

namespace dtof {
namespace {

constexpr std::array<const char*, 2> kReferences = {"matchedfilter", "pooledmatchedfilter"};
constexpr std::array<const char*, 4> kOutcomes = {"within_3", "within_10", "beyond", "sky"};
// Rows of a stored cell behind the outcomes.
constexpr std::size_t kNearRow = kOutcomes.size();
constexpr std::size_t kErrorRow = kNearRow + 1;
constexpr std::array<double, 6> kWalls = {1.0, 1.5, 2.0, 3.0, 4.0, 5.0};  // m, of the own instants
// Seeds of the walls, likewise none of a scene's.
constexpr std::uint64_t kWallSeeds = 2'000'000;
// Seeds of the sky frames that set the thresholds: none of a scene's.
constexpr std::uint64_t kSkySeeds = 1'000'000;

SensorModel sensor_under(const HostileSettings& settings, const std::string& condition) {
  return condition == kClear ? settings.sensor : under_condition(settings.sensor, condition);
}

bool has_compensation(const ReadoutParameters& readout) {
  return is_pool_readout(readout.readout) || readout.readout == Readout::kCoarseHistogram;
}

/// The estimators that have settings for the surroundings of `sensor`, with these settings.
Estimators with_compensation(const HostileSettings& settings, const SensorModel& sensor,
                             const std::vector<RangeConverter>& tables) {
  Estimators compensated{.readouts = {}, .names = compensated_estimators(settings), .tables = {}};
  std::vector<ColumnStream> empty;
  if (has_own_light(sensor)) {
    empty = empty_columns(sensor, settings.seed);
    compensated.returns = mean_returns(empty, sensor);
  }
  compensated.settle = silent_acquisitions(sensor);
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    if (!has_compensation(settings.readouts[r])) {
      continue;
    }
    ReadoutParameters readout = settings.readouts[r];
    if (!empty.empty() && is_pool_readout(readout.readout)) {
      readout.pool.coarse_template = measured_template(empty, sensor.acquisitions, readout);
    }
    if (!sensor.surroundings.skew.none()) {
      readout.pool.smooth = false;
    }
    compensated.readouts.push_back(readout);
    compensated.tables.push_back(tables[r]);
  }
  compensated.tables.insert(compensated.tables.end(), tables.end() - kReferences.size(), tables.end());
  return compensated;
}

/// Mean error of an estimator's pixels near their target, over all seeds; none where most are elsewhere.
std::optional<double> error_of_most(const std::vector<HostileCounts>& seeds) {
  std::uint64_t pixels = 0;
  std::uint64_t near = 0;
  for (const HostileCounts& counts : seeds) {
    pixels += counts.targets();
    near += counts.near_target;
  }
  return 2 * near > pixels ? std::optional(mean_error(seeds)) : std::nullopt;
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
      table.add({name, fmt::format("{}", seed), fmt::format("{}", kNearRow), "0",
                 fmt::format("{}", seeds[seed].near_target)});
      table.add({name, fmt::format("{}", seed), fmt::format("{}", kErrorRow), "0",
                 fmt::format("{}", seeds[seed].error_um)});
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
    HostileCounts& counts = own.at(static_cast<std::size_t>(seed[i]));
    const auto row = static_cast<std::size_t>(outcome[i]);
    if (row == kNearRow) {
      counts.near_target = static_cast<std::uint64_t>(pixels[i]);
    } else if (row == kErrorRow) {
      counts.error_um = static_cast<std::int64_t>(pixels[i]);
    } else {
      counts.by_confidence.at(row)[static_cast<int>(confidence[i])] = static_cast<std::uint64_t>(pixels[i]);
    }
  }
  return readouts;
}

void validate(const HostileSettings& settings) {
  if (settings.readouts.empty() || settings.klux.empty() || settings.scenes.empty()) {
    throw InputError("hostile scenes: needs a read-out, a light and a scene");
  }
  if (std::ranges::find(settings.conditions, kClear) == settings.conditions.end()) {
    throw InputError(
        "hostile scenes: the cost of a condition is stated beside the condition \"clear\", which is missing");
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

std::vector<std::string> compensated_estimators(const HostileSettings& settings) {
  std::vector<std::string> names;
  for (const ReadoutParameters& readout : settings.readouts) {
    if (has_compensation(readout)) {
      names.emplace_back(readout_name(readout.readout));
    }
  }
  names.insert(names.end(), kReferences.begin(), kReferences.end());
  return names;
}

std::uint32_t silent_acquisitions(const SensorModel& sensor) {
  return static_cast<std::uint32_t>(
      std::ceil(sensor.surroundings.settling.silent_share * sensor.acquisitions));
}

bool moves(const HostileSettings& settings, const std::string& condition) {
  return travel_of_a_frame(sensor_under(settings, condition)) != 0.0;
}

std::vector<std::string> compensated_conditions(const HostileSettings& settings) {
  std::vector<std::string> names;
  for (const std::string& condition : settings.conditions) {
    const SensorModel sensor = sensor_under(settings, condition);
    if (has_own_light(sensor) || !sensor.surroundings.skew.none() || silent_acquisitions(sensor) > 0 ||
        moves(settings, condition)) {
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

namespace {

/// A run: the cells that are done, and what the others need.
class HostileRun {
 public:
  explicit HostileRun(const HostileSettings& settings)
      : settings_(settings),
        progress_("hostile scenes",
                  (settings.conditions.size() + compensated_conditions(settings).size() + 1) *
                      settings.klux.size()) {
    for (const Scene scene : settings.scenes) {
      scenes_.push_back(middle_of(scene, settings.sensor, settings.rows));
    }
  }

  /// Frames of sky alone, as bright as a surface of the sensor's reflectivity, as the sky of the scene is.
  HostileReadouts sky(double klux) {
    return stored_or("only-sky", klux, [&] {
      return measure_hostile(settings_, all(klux), settings_.sensor, klux, {flat(0.0)},
                             settings_.seed + kSkySeeds);
    });
  }

  HostileReadouts uncompensated(const std::string& condition, double klux) {
    return stored_or(condition, klux, [&] {
      return measure_hostile(settings_, all(klux), sensor_under(settings_, condition), klux, scenes_,
                             settings_.seed);
    });
  }

  /// `instants`: of the estimators under a condition in which targets move, else null.
  HostileReadouts compensated(const std::string& condition, double klux, const OwnInstants* instants) {
    return stored_or("told-" + condition, klux, [&] {
      const SensorModel sensor = sensor_under(settings_, condition);
      Estimators estimators =
          instants != nullptr ? all(klux) : with_compensation(settings_, sensor, tables(klux));
      estimators.instants = instants;
      return measure_hostile(settings_, estimators, sensor, klux, scenes_, settings_.seed);
    });
  }

  OwnInstants instants(const std::string& condition, double klux) {
    OwnInstants own{.distances_m = {kWalls.begin(), kWalls.end()}, .instants = {}};
    SensorModel away = sensor_under(settings_, condition);
    SensorModel nearer = away;
    nearer.surroundings.motion.velocity_m_per_s *= -1.0;
    const double travel = travel_of_a_frame(away);
    for (const double distance : kWalls) {
      const auto wall = [&](const char* way, const SensorModel& sensor) {
        return stored_or(
            fmt::format("wall-{:g}-{}-{}", distance, condition, way), klux,
            [&] {
              return measure_hostile(settings_, all(klux), sensor, klux, {flat(distance)},
                                     settings_.seed + kWallSeeds);
            },
            0);
      };
      const HostileReadouts going = wall("away", away);
      const HostileReadouts coming = wall("nearer", nearer);
      for (const auto& [name, seeds] : going) {
        const std::optional<double> error_going = error_of_most(seeds);
        const std::optional<double> error_coming = error_of_most(coming.at(name));
        own.instants[name].push_back(error_going && error_coming
                                         ? std::optional(own_instant(*error_going, *error_coming, travel))
                                         : std::nullopt);
      }
    }
    return own;
  }

 private:
  template <typename Make>
  HostileReadouts stored_or(const std::string& name, double klux, const Make& make, int steps = 1) {
    const std::filesystem::path file = settings_.store / fmt::format("{}_{:g}.csv", name, klux);
    if (!std::filesystem::exists(file)) {
      store_cell(file, make());
    }
    progress_.advance(steps);
    return stored_cell(file, settings_.seeds);
  }

  [[nodiscard]] TargetMap flat(double distance) const {
    return {engine_columns_read(), settings_.rows, {distance, settings_.sensor.default_reflectivity}};
  }

  const std::vector<RangeConverter>& tables(double klux) {
    const auto found = fitted_.find(klux);
    return found != fitted_.end() ? found->second
                                  : fitted_.emplace(klux, fit_hostile_tables(settings_, klux)).first->second;
  }

  Estimators all(double klux) {
    return {.readouts = settings_.readouts, .names = hostile_estimators(settings_), .tables = tables(klux)};
  }

  const HostileSettings& settings_;
  Progress progress_;
  std::vector<TargetMap> scenes_;
  std::map<double, std::vector<RangeConverter>> fitted_;
};

}  // namespace

HostileScenes run_hostile_scenes(const HostileSettings& settings) {
  validate(settings);
  for (const std::string& condition : settings.conditions) {
    (void)sensor_under(settings, condition);  // refuses unknown ones before anything is measured
  }
  create_output_folder(settings.store);
  HostileRun run(settings);
  HostileScenes study;
  std::map<std::string, std::vector<std::vector<HostileCounts>>> skies;
  for (const double klux : settings.klux) {
    for (const auto& [name, seeds] : run.sky(klux)) {
      skies[name].push_back(seeds);
    }
    for (const std::string& condition : settings.conditions) {
      study.cells[{condition, klux}] = run.uncompensated(condition, klux);
    }
    for (const std::string& condition : compensated_conditions(settings)) {
      const HostileCell cell{condition, klux};
      if (moves(settings, condition)) {
        study.instants[cell] = run.instants(condition, klux);
      }
      const auto instants = study.instants.find(cell);
      study.compensated[cell] =
          run.compensated(condition, klux, instants != study.instants.end() ? &instants->second : nullptr);
    }
  }
  for (const auto& [name, lights] : skies) {
    study.thresholds[name] = least_confidence(lights, settings.false_alarms);
  }
  return study;
}

double mean_error(const std::vector<HostileCounts>& seeds) {
  double sum = 0.0;
  double pixels = 0.0;
  for (const HostileCounts& counts : seeds) {
    sum += 1e-6 * static_cast<double>(counts.error_um);
    pixels += static_cast<double>(counts.near_target);
  }
  return pixels > 0.0 ? sum / pixels : 0.0;
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
