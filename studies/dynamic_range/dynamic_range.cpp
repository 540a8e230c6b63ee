// SPDX-License-Identifier: Apache-2.0
#include "dynamic_range/dynamic_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "common/engine_frame.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/parallel.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/csv_table.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

constexpr int kWideCounters = 16;

struct Limit {
  int percent;
  std::uint64_t RangeCounts::*figure;
};
constexpr std::array<Limit, 2> kLimits = {
    {{3, &RangeCounts::above_3_percent}, {10, &RangeCounts::above_10_percent}}};

SensorModel sensor_of(const RangeSettings& settings, const RangeCell& cell) {
  SensorModel sensor = settings.sensor;
  sensor.signal_events_1m *= cell.signal;
  sensor.acquisitions = cell.acquisitions;
  return sensor;
}

/// The same read-out with counters that do not fill; none if it has no such counters.
std::optional<ReadoutParameters> with_wide_counters(ReadoutParameters readout) {
  if (is_pool_readout(readout.readout) || !has_parameter(readout.readout, "COUNT_WIDTH")) {
    return std::nullopt;
  }
  readout.count_width = kWideCounters;
  return readout;
}

/// Confidence of all ones; none where a pool read-out's has another meaning.
std::optional<std::uint16_t> full_confidence(const ReadoutParameters& readout) {
  if (is_pool_readout(readout.readout)) {
    return std::nullopt;
  }
  const int width = is_pointer_readout(readout.readout) ? readout.confidence_width : readout.count_width;
  return static_cast<std::uint16_t>((1U << static_cast<unsigned>(width)) - 1U);
}

/// Distances that a read-out gave, and the truth.
struct Judged {
  double truth_m;
  double measured_m;

  [[nodiscard]] bool above(double share) const { return std::abs(measured_m - truth_m) > share * truth_m; }
};
constexpr double kAboveThree = 0.03;
constexpr double kAboveTen = 0.10;

RangeCounts& operator+=(RangeCounts& sum, const RangeCounts& part) {
  sum.pixels += part.pixels;
  sum.above_3_percent += part.above_3_percent;
  sum.above_10_percent += part.above_10_percent;
  sum.full += part.full;
  sum.full_above_3_percent += part.full_above_3_percent;
  sum.changed += part.changed;
  sum.wide_above_3_percent += part.wide_above_3_percent;
  sum.wide_above_10_percent += part.wide_above_10_percent;
  return sum;
}

std::uint64_t one_if(bool condition) { return condition ? 1 : 0; }

/// Detections of a pixel at 2 m, roughly: what a cell costs.
double cost_of(const RangeSettings& settings, const RangeCell& cell) {
  constexpr double kTypicalDistance = 2.0;
  const SensorModel sensor = sensor_of(settings, cell);
  const double events =
      sensor.signal_events(kTypicalDistance, 1.0) + sensor.background_events(cell.klux, 1.0);
  return 1.0 + cell.acquisitions * std::min(events, static_cast<double>(sensor.slots));
}

constexpr std::array<std::pair<const char*, std::uint64_t RangeCounts::*>, 8> kStored = {
    {{"pixels", &RangeCounts::pixels},
     {"above_3_percent", &RangeCounts::above_3_percent},
     {"above_10_percent", &RangeCounts::above_10_percent},
     {"full", &RangeCounts::full},
     {"full_above_3_percent", &RangeCounts::full_above_3_percent},
     {"changed", &RangeCounts::changed},
     {"wide_above_3_percent", &RangeCounts::wide_above_3_percent},
     {"wide_above_10_percent", &RangeCounts::wide_above_10_percent}}};

std::filesystem::path cell_file(const RangeSettings& settings, const RangeCell& cell,
                                const std::string& what) {
  return settings.store /
         fmt::format("{}_{:g}_{:g}_{}_{}.csv", what, cell.signal, cell.klux, cell.acquisitions, cell.repeat);
}

void store_cell(const std::filesystem::path& file, const RangeReadouts& readouts) {
  std::vector<std::string> header = {"readout"};
  for (const auto& [name, figure] : kStored) {
    header.emplace_back(name);
  }
  Table table(std::move(header));
  for (const auto& [readout, seeds] : readouts) {
    for (const RangeCounts& counts : seeds) {
      std::vector<std::string> row = {readout};
      for (const auto& [name, figure] : kStored) {
        row.push_back(fmt::format("{}", counts.*figure));
      }
      table.add(std::move(row));
    }
  }
  write_file(file, table.csv());
}

RangeReadouts stored_cell(const std::filesystem::path& file) {
  const CsvTable table(file);
  const std::vector<std::string> names = table.texts("readout");
  std::vector<RangeCounts> counts(names.size());
  for (const auto& [name, figure] : kStored) {
    const std::vector<double> values = table.column(name);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      counts[i].*figure = static_cast<std::uint64_t>(values[i]);
    }
  }
  RangeReadouts readouts;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    readouts[names[i]].push_back(counts[i]);
  }
  return readouts;
}

void validate(const RangeSettings& settings) {
  if (settings.readouts.empty() || settings.acquisitions.empty() || settings.klux.empty() ||
      settings.signals.empty() || settings.scenes.empty()) {
    throw InputError("dynamic range: needs a read-out, acquisitions, a light, a signal and a scene");
  }
  if (settings.seeds < 2) {
    throw InputError(
        fmt::format("dynamic range: an interval needs at least 2 seeds, not {}", settings.seeds));
  }
  if (settings.sensor.columns < engine_columns_read() || settings.sensor.rows < settings.rows ||
      settings.rows < 1) {
    throw InputError(
        fmt::format("dynamic range: {} rows of {} columns are read, but the sensor has {} rows of {}",
                    settings.rows, engine_columns_read(), settings.sensor.rows, settings.sensor.columns));
  }
  for (const double signal : settings.signals) {
    if (!std::isfinite(signal) || signal <= 0.0) {
      throw InputError(fmt::format("dynamic range: a signal must be finite and above 0, not {}", signal));
    }
  }
  if (settings.sensor.binning != 1 || settings.sensor.coincidence_window_s) {
    throw InputError("dynamic range: binning and coincidence would look beyond the pixels that are read");
  }
}

bool beyond(const Estimate& worse, const Estimate& better) {
  return worse.interval.low > better.interval.high;
}

bool is_pool(const std::string& name) { return is_pool_readout(parse_readout(name)); }

/// Whether only this quantity differs, and is smaller in `a`.
bool is_before(const RangeCell& a, const RangeCell& b, Grown grown) {
  if (a.klux != b.klux || a.repeat != b.repeat) {
    return false;
  }
  return grown == Grown::kAcquisitions ? a.signal == b.signal && a.acquisitions < b.acquisitions
                                       : a.acquisitions == b.acquisitions && a.signal < b.signal;
}

const std::string& coarse_histogram() {
  static const std::string name(readout_name(Readout::kCoarseHistogram));
  return name;
}

}  // namespace

bool about_pool_readout(const RangeFinding& finding) { return is_pool(finding.readout); }

RangeReadouts measure_range_cell(const RangeSettings& settings, const RangeCell& cell, bool wide) {
  const SensorModel sensor = sensor_of(settings, cell);
  std::vector<ReadoutParameters> readouts = settings.readouts;
  std::vector<std::size_t> wide_of(settings.readouts.size(), 0);  // index in `readouts`; 0: none
  for (std::size_t r = 0; wide && r < settings.readouts.size(); ++r) {
    if (const std::optional<ReadoutParameters> other = with_wide_counters(settings.readouts[r])) {
      wide_of[r] = readouts.size();
      readouts.push_back(*other);
    }
  }
  const std::uint64_t first_seed =
      settings.seed + static_cast<std::uint64_t>(cell.repeat) * static_cast<std::uint64_t>(settings.seeds);
  const std::vector<RangeConverter> tables = FlatCalibration(sensor).fit(
      [&](const TargetMap& targets) {
        return std::make_unique<PhotonSource>(sensor, targets, cell.klux, first_seed,
                                              FlatCalibration::kFrame);
      },
      readouts, first_seed, settings.threads);
  std::vector<TargetMap> scenes;
  for (const Scene scene : settings.scenes) {
    scenes.push_back(middle_of(scene, sensor, settings.rows));
  }
  const auto seeds = static_cast<std::size_t>(settings.seeds);
  std::vector<std::vector<RangeCounts>> counts(scenes.size() * seeds,
                                               std::vector<RangeCounts>(settings.readouts.size()));
  parallel_for(counts.size(), settings.threads, [&](std::size_t index) {
    const std::size_t s = index / seeds;
    const PhotonSource source(sensor, scenes[s], cell.klux, first_seed + index % seeds,
                              scene_frame(static_cast<std::uint32_t>(s)));
    const std::vector<EngineResults> results = read_engine(source, readouts);
    for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
      RangeCounts& own = counts[index][r];
      const std::optional<std::uint16_t> full = full_confidence(readouts[r]);
      for (int column = 0; column < engine_columns_judged(); ++column) {
        for (int row = 0; row < settings.rows; ++row) {
          const PixelTarget& target = scenes[s].at(column, row);
          if (!target.returns_signal()) {
            continue;
          }
          const auto measured = [&](std::size_t readout) {
            const PixelResult& result =
                results[readout][static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
            return Judged{
                target.depth_m,
                tables[readout].distance(to_measurement(result, readouts[readout].fraction_bits).position)};
          };
          const PixelResult& result =
              results[r][static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
          const Judged judged = measured(r);
          RangeCounts pixel = {.pixels = 1,
                               .above_3_percent = one_if(judged.above(kAboveThree)),
                               .above_10_percent = one_if(judged.above(kAboveTen)),
                               .full = one_if(full && result.confidence == *full)};
          pixel.full_above_3_percent = pixel.full * pixel.above_3_percent;
          if (wide_of[r] != 0) {
            const PixelResult& other =
                results[wide_of[r]][static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
            const Judged judged_wide = measured(wide_of[r]);
            pixel.changed = one_if(other.code != result.code || other.fraction != result.fraction);
            pixel.wide_above_3_percent = one_if(judged_wide.above(kAboveThree));
            pixel.wide_above_10_percent = one_if(judged_wide.above(kAboveTen));
          }
          own += pixel;
        }
      }
    }
  });
  RangeReadouts summed;
  for (std::size_t r = 0; r < settings.readouts.size(); ++r) {
    std::vector<RangeCounts>& own = summed[std::string(readout_name(settings.readouts[r].readout))];
    own.resize(seeds);
    for (std::size_t index = 0; index < counts.size(); ++index) {
      own[index % seeds] += counts[index][r];
    }
  }
  return summed;
}

RangeResults measure_range_cells(const RangeSettings& settings, std::vector<RangeCell> cells,
                                 const std::string& what, bool wide) {
  validate(settings);
  create_output_folder(settings.store);
  std::ranges::stable_sort(cells, {}, [&](const RangeCell& cell) { return cost_of(settings, cell); });
  double total = 0.0;
  for (const RangeCell& cell : cells) {
    total += cost_of(settings, cell);
  }
  constexpr double kSteps = 1000.0;
  Progress progress("dynamic range, " + what, static_cast<std::size_t>(kSteps));
  RangeResults results;
  double done = 0.0;
  for (const RangeCell& cell : cells) {
    const std::filesystem::path file = cell_file(settings, cell, what);
    if (std::filesystem::exists(file)) {
      results[cell] = stored_cell(file);
    } else {
      results[cell] = measure_range_cell(settings, cell, wide);
      store_cell(file, results[cell]);
    }
    const auto before = static_cast<std::size_t>(kSteps * done / total);
    done += cost_of(settings, cell);
    progress.advance(static_cast<std::size_t>(kSteps * done / total) - before);
  }
  return results;
}

std::vector<RangeCell> range_grid(const RangeSettings& settings) {
  std::vector<RangeCell> cells;
  for (const double signal : settings.signals) {
    for (const double klux : settings.klux) {
      for (const std::uint32_t acquisitions : settings.acquisitions) {
        cells.push_back({signal, klux, acquisitions});
      }
    }
  }
  return cells;
}

Estimate range_share(const std::vector<RangeCounts>& seeds, std::uint64_t RangeCounts::*figure) {
  std::vector<double> shares;
  for (const RangeCounts& counts : seeds) {
    shares.push_back(static_cast<double>(counts.*figure) / static_cast<double>(counts.pixels));
  }
  return estimate_share_of_frames(shares, seeds.front().pixels);
}

std::vector<RangeFinding> worse_with_more(const RangeResults& results, Grown grown) {
  std::vector<RangeFinding> findings;
  for (const auto& [cell, readouts] : results) {
    for (const auto& [readout, seeds] : readouts) {
      for (const Limit& limit : kLimits) {
        const Estimate share = range_share(seeds, limit.figure);
        std::optional<RangeFinding> worst;
        for (const auto& [other, others] : results) {
          if (!is_before(other, cell, grown) || !others.contains(readout)) {
            continue;
          }
          const Estimate before = range_share(others.at(readout), limit.figure);
          if (beyond(share, before) && (!worst || before.interval.high < worst->better_share.interval.high)) {
            worst = RangeFinding{readout, limit.percent, cell, other, readout, share, before};
          }
        }
        if (worst) {
          findings.push_back(*worst);
        }
      }
    }
  }
  return findings;
}

std::vector<RangeFinding> behind_coarse_histogram(const RangeResults& results, std::uint32_t acquisitions) {
  std::vector<RangeFinding> findings;
  for (const auto& [cell, readouts] : results) {
    const auto coarse = readouts.find(coarse_histogram());
    if (cell.acquisitions < acquisitions || coarse == readouts.end()) {
      continue;
    }
    for (const auto& [readout, seeds] : readouts) {
      for (const Limit& limit : kLimits) {
        const Estimate share = range_share(seeds, limit.figure);
        const Estimate better = range_share(coarse->second, limit.figure);
        if (is_pool(readout) && beyond(share, better)) {
          findings.push_back({readout, limit.percent, cell, cell, coarse_histogram(), share, better});
        }
      }
    }
  }
  return findings;
}

std::vector<RangeFinding> confirmed(const std::vector<RangeFinding>& findings, const RangeResults& results) {
  std::vector<RangeFinding> kept;
  for (const RangeFinding& finding : findings) {
    const auto again = [&](RangeCell cell, const std::string& readout) {
      cell.repeat = 1;
      const auto* const limit = std::ranges::find(kLimits, finding.limit_percent, &Limit::percent);
      return range_share(results.at(cell).at(readout), limit->figure);
    };
    if (beyond(again(finding.cell, finding.readout), again(finding.better_cell, finding.better_readout))) {
      kept.push_back(finding);
    }
  }
  return kept;
}

DynamicRange run_dynamic_range(const RangeSettings& settings) {
  DynamicRange result;
  result.grid = measure_range_cells(settings, range_grid(settings), "grid");
  result.more_acquisitions = worse_with_more(result.grid, Grown::kAcquisitions);
  result.more_signal = worse_with_more(result.grid, Grown::kSignal);
  result.behind = behind_coarse_histogram(result.grid, kManyAcquisitions);

  // One comparison in some hundred goes beyond both intervals by chance.
  std::set<RangeCell> again;
  for (const auto* const findings : {&result.more_acquisitions, &result.more_signal, &result.behind}) {
    for (const RangeFinding& finding : *findings) {
      if (about_pool_readout(finding)) {
        for (RangeCell cell : {finding.cell, finding.better_cell}) {
          cell.repeat = 1;
          again.insert(cell);
        }
      }
    }
  }
  RangeSettings few = settings;
  std::erase_if(few.readouts, [](const ReadoutParameters& readout) {
    return !is_pool_readout(readout.readout) && readout.readout != Readout::kCoarseHistogram;
  });
  const RangeResults repeated =
      again.empty() ? RangeResults() : measure_range_cells(few, {again.begin(), again.end()}, "again");
  for (auto* const findings : {&result.more_acquisitions, &result.more_signal, &result.behind}) {
    std::vector<RangeFinding> pool;
    std::ranges::copy_if(*findings, std::back_inserter(pool), about_pool_readout);
    std::erase_if(*findings, about_pool_readout);
    const std::vector<RangeFinding> kept = confirmed(pool, repeated);
    result.unconfirmed += pool.size() - kept.size();
    findings->insert(findings->end(), kept.begin(), kept.end());
  }

  // Full counters: the longest frames, with the most signal and with the sensor's own.
  std::vector<RangeCell> full;
  std::vector<std::uint32_t> longest = settings.acquisitions;
  std::ranges::sort(longest, std::greater<>());
  longest.resize(std::min<std::size_t>(longest.size(), 2));
  for (const double klux : settings.klux) {
    full.push_back({1.0, klux, longest.back()});
    full.push_back({std::ranges::max(settings.signals), klux, longest.front()});
  }
  RangeSettings counters = settings;
  counters.seeds = std::min(settings.seeds, 2);
  std::erase_if(counters.readouts,
                [](const ReadoutParameters& readout) { return !with_wide_counters(readout); });
  if (!counters.readouts.empty()) {
    result.full = measure_range_cells(counters, full, "full", true);
  }
  return result;
}

}  // namespace dtof
