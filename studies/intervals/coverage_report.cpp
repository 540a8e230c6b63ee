// SPDX-License-Identifier: Apache-2.0
#include "intervals/coverage_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "dtof/metrics/error_statistics.hpp"

namespace dtof {
namespace {

std::string_view verdict_word(CoverageVerdict verdict) {
  switch (verdict) {
    case CoverageVerdict::kHolds:
      return "holds";
    case CoverageVerdict::kHoldsRedrawn:
      return "holds redrawn";
    default:
      return "fails";
  }
}

std::string state_word(bool after_table) { return after_table ? "after the table" : "before the table"; }

double coverage(const RunStatistics& statistics) {
  return static_cast<double>(statistics.covered) / static_cast<double>(statistics.runs);
}

/// What some cells have in common: how they were judged, and their extremes.
struct Group {
  int by_spread = 0;
  int by_coverage = 0;
  int redrawn = 0;           // of those judged by the spread
  int redrawn_coverage = 0;  // of the others
  int failed = 0;
  double least_ratio = 0.0;
  double most_ratio = 0.0;
  double least_coverage = 1.0;

  void add(const CoverageCell& cell) {
    failed += cell.verdict == CoverageVerdict::kFails ? 1 : 0;
    if (!cell.by_spread) {
      ++by_coverage;
      least_coverage = std::min(least_coverage, coverage(cell.redrawn ? *cell.redrawn : cell.seen));
      redrawn_coverage += cell.verdict == CoverageVerdict::kHoldsRedrawn ? 1 : 0;
      return;
    }
    redrawn += cell.verdict == CoverageVerdict::kHoldsRedrawn ? 1 : 0;
    const double ratio = (cell.redrawn ? *cell.redrawn : cell.seen).spread_ratio();
    least_ratio = by_spread == 0 ? ratio : std::min(least_ratio, ratio);
    most_ratio = by_spread == 0 ? ratio : std::max(most_ratio, ratio);
    ++by_spread;
  }

  [[nodiscard]] std::string ratios() const {
    return by_spread == 0 ? "-" : fmt::format("{:.2f} to {:.2f} ({})", least_ratio, most_ratio, by_spread);
  }
  [[nodiscard]] std::string coverages() const {
    return by_coverage == 0 ? "-" : fmt::format("{:.1f} % ({})", least_coverage * 100.0, by_coverage);
  }
};

template <typename Key>
std::map<Key, Group> groups(std::span<const CoverageCell> cells, Key (*key)(const CoverageCell&)) {
  std::map<Key, Group> result;
  for (const CoverageCell& cell : cells) {
    result[key(cell)].add(cell);
  }
  return result;
}

std::size_t holding_at_once(const CoverageStudy& study, bool by_spread) {
  return static_cast<std::size_t>(std::ranges::count_if(study.cells, [&](const CoverageCell& cell) {
    return cell.by_spread == by_spread && cell.verdict == CoverageVerdict::kHolds;
  }));
}

/// How many cells hold, and what judged them.
void set_verdict(PageData& data, const CoverageStudy& study) {
  Group all;
  for (const CoverageCell& cell : study.cells) {
    all.add(cell);
  }
  data.set("holding", "{}", study.cells.size() - static_cast<std::size_t>(all.failed))
      .set("cells", "{}", study.cells.size())
      .set("by_spread", "{}", all.by_spread)
      .set("spread_at_once", "{}", holding_at_once(study, true))
      .set("spread_redrawn", "{}", all.redrawn)
      .set("by_coverage", "{}", all.by_coverage)
      .set("coverage_at_once", "{}", holding_at_once(study, false))
      .set("coverage_redrawn", "{}", all.redrawn_coverage);
}

Table by_figure(const CoverageSettings& settings, const CoverageStudy& study) {
  using Key = std::pair<std::pair<bool, Figure>, int>;
  const std::map<Key, Group> all = groups<Key>(study.cells, [](const CoverageCell& cell) {
    return Key{{cell.after_table, cell.figure}, cell.frames};
  });
  std::vector<std::string> header = {"figure", "table"};
  for (const int frames : settings.frames) {
    header.push_back(fmt::format("{} frames: spread / standard error", frames));
    header.emplace_back("least coverage, few outliers");
    header.emplace_back("fail");
  }
  Table table(header, 2);
  for (const bool after : {false, true}) {
    for (const Figure figure : kFigures) {
      std::vector<std::string> row = {std::string(figure_name(figure)), after ? "after" : "before"};
      for (const int frames : settings.frames) {
        const Group& group = all.at({{after, figure}, frames});
        row.push_back(group.ratios());
        row.push_back(group.coverages());
        row.push_back(fmt::format("{}", group.failed));
      }
      table.add(row);
    }
  }
  return table;
}

Table by_readout(const CoverageStudy& study) {
  using Key = std::pair<std::string, std::pair<bool, Figure>>;
  const std::map<Key, Group> all = groups<Key>(study.cells, [](const CoverageCell& cell) {
    return Key{cell.title, {cell.after_table, cell.figure}};
  });
  std::vector<std::string> titles;
  for (const CoverageCell& cell : study.cells) {
    if (std::ranges::find(titles, cell.title) == titles.end()) {
      titles.push_back(cell.title);
    }
  }
  std::vector<std::string> header = {"spread / standard error", "table"};
  for (const Figure figure : kFigures) {
    header.emplace_back(figure_name(figure));
  }
  Table table(header, 2);
  for (const std::string& title : titles) {
    for (const bool after : {false, true}) {
      std::vector<std::string> row = {title, after ? "after" : "before"};
      for (const Figure figure : kFigures) {
        row.push_back(all.at({title, {after, figure}}).ratios());
      }
      table.add(row);
    }
  }
  return table;
}

std::string covered(const RunStatistics& statistics) {
  return fmt::format("{} of {}", statistics.covered, statistics.runs);
}

/// The cells that lie outside with the seeds' own runs; nothing if none does.
std::optional<PageData> outside_data(const CoverageStudy& study) {
  Table table({"read-out", "figure", "klux", "m", "frames", "spread / standard error", "drawn again",
               "intervals that hold the truth", "drawn again", "verdict"},
              2);
  for (const CoverageCell& cell : study.cells) {
    if (cell.verdict == CoverageVerdict::kHolds) {
      continue;
    }
    table.add({cell.title, fmt::format("{} {}", figure_name(cell.figure), state_word(cell.after_table)),
               fmt::format("{:g}", cell.klux), fmt::format("{:g}", cell.distance_m),
               fmt::format("{}", cell.frames),
               cell.by_spread ? fmt::format("{:.2f}", cell.seen.spread_ratio()) : "-",
               cell.by_spread && cell.redrawn ? fmt::format("{:.2f}", cell.redrawn->spread_ratio()) : "-",
               covered(cell.seen), cell.redrawn ? covered(*cell.redrawn) : "-",
               std::string(verdict_word(cell.verdict))});
  }
  return table.cells().size() == 1 ? std::nullopt : std::optional(PageData().set("cells_outside", table));
}

std::optional<PageData> other_tables_data(const CoverageSettings& settings, const CoverageStudy& study) {
  if (study.tables.empty()) {
    return std::nullopt;
  }
  std::vector<std::string> titles;
  for (const TableSpread& spread : study.tables) {
    if (std::ranges::find(titles, spread.title) == titles.end()) {
      titles.push_back(spread.title);
    }
  }
  constexpr std::array kAfterTable = {Figure::kRmse, Figure::kAbove3Percent, Figure::kOutlierRate};
  std::vector<std::string> header = {"median over places (largest)"};
  for (const Figure figure : kAfterTable) {
    header.emplace_back(figure_name(figure));
  }
  Table table(header);
  for (const std::string& title : titles) {
    std::vector<std::string> row = {title};
    for (const Figure figure : kAfterTable) {
      std::vector<double> ratios;
      for (const TableSpread& spread : study.tables) {
        if (spread.title == title && spread.figure == figure && spread.standard_error > 0.0) {
          ratios.push_back(spread.deviation / spread.standard_error);
        }
      }
      row.push_back(
          ratios.empty() ? "-" : fmt::format("{:.2f} ({:.2f})", median(ratios), std::ranges::max(ratios)));
    }
    table.add(row);
  }
  return PageData()
      .set("calibration_frames", "{}", settings.study.calibration_frames)
      .set("calibration_step", "{:g}", settings.study.calibration_step_m)
      .set("calibrations", "{}", settings.other_calibrations)
      .set("reported_frames", "{}", study.tables.front().frames)
      .set("spreads", table);
}

/// Where --precision stops, and the stops that fail.
void set_stopping(PageData& data, const CoverageSettings& settings, const CoverageStudy& study) {
  Table table({"--precision", "places and read-outs", "seeds", "reached", "mean frames there",
               "relative precision right", "rmse right", "mean of rmse / truth - 1", "fail"});
  Table failures(
      {"read-out", "klux", "m", "--precision", "reached", "relative precision right", "rmse right"});
  std::size_t all_failed = 0;
  for (const double precision : settings.precisions) {
    std::uint64_t places = 0;
    std::uint64_t failed = 0;
    StoppingCell sum;
    for (const StoppingCell& cell : study.stopping) {
      if (cell.precision != precision) {
        continue;
      }
      const auto reached = static_cast<double>(cell.reached);
      ++places;
      sum.seeds += cell.seeds;
      sum.reached += cell.reached;
      sum.precision_right += cell.precision_right;
      sum.rmse_right += cell.rmse_right;
      sum.mean_frames += reached * cell.mean_frames;
      sum.mean_rmse_error += reached * cell.mean_rmse_error;
      if (!cell.holds()) {
        ++failed;
        failures.add({cell.title, fmt::format("{:g}", cell.klux), fmt::format("{:g}", cell.distance_m),
                      fmt::format("{:g} %", precision * 100.0), fmt::format("{}", cell.reached),
                      fmt::format("{}", cell.precision_right), fmt::format("{}", cell.rmse_right)});
      }
    }
    const double all = std::max<double>(1.0, static_cast<double>(sum.reached));
    table.add({fmt::format("{:g} %", precision * 100.0), fmt::format("{}", places),
               fmt::format("{}", sum.seeds), fmt::format("{}", sum.reached),
               fmt::format("{:.0f}", sum.mean_frames / all),
               fmt::format("{:.2f} %", 100.0 * static_cast<double>(sum.precision_right) / all),
               fmt::format("{:.2f} %", 100.0 * static_cast<double>(sum.rmse_right) / all),
               fmt::format("{:+.2f} %", 100.0 * sum.mean_rmse_error / all), fmt::format("{}", failed)});
    all_failed += failed;
  }
  std::optional<PageData> failing;
  if (all_failed > 0) {
    failing = PageData().set("failing", "{}", all_failed).set("failing_stops", failures);
  }
  data.set("rare_outliers", "{:g}", settings.study.rare_outliers * 100.0)
      .set("stopping", table)
      .set("stops", "{}", study.stopping.size())
      .part("failures", std::move(failing));
}

}  // namespace

std::size_t coverage_failures(const CoverageStudy& study) {
  const auto cells =
      std::ranges::count(study.cells, CoverageVerdict::kFails, &CoverageCell::verdict) +
      std::ranges::count_if(study.stopping, [](const StoppingCell& cell) { return !cell.holds(); });
  return static_cast<std::size_t>(cells);
}

PageData coverage_page(const CoverageSettings& settings, const CoverageStudy& study,
                       const std::string& command_line) {
  PageData data;
  data.set("seeds", "{}", settings.seeds)
      .set("first_seed", "{}", settings.study.run.seed)
      .set("frames", "{}", settings.frames.back())
      .set("klux", "{}", fmt::join(settings.klux, ", "))
      .set("distances", "{}", fmt::join(settings.distances_m, ", "))
      .set("shortest_runs", "{}", settings.seeds * (settings.frames.back() / settings.frames.front()))
      .set("fewest_frames", "{}", settings.frames.front())
      .set("sensor", "{}", settings.study.sensor.name)
      .set("calibration_seed", "{}", settings.study.calibration_seed)
      .set("all_frames", "{}", settings.seeds * settings.frames.back())
      .set("least_ratio", "{:g}", kLeastSpreadRatio)
      .set("most_ratio", "{:g}", kMostSpreadRatio)
      .set("uncertainty", "{:.0f}", 100.0 / std::sqrt(2.0 * (settings.seeds - 1)))
      .set("redrawn_runs", "{}", kRedrawnRuns);
  set_verdict(data, study);
  data.set("by_figure", by_figure(settings, study))
      .set("by_readout", by_readout(study))
      .part("outside", outside_data(study));
  set_stopping(data, settings, study);
  data.part("other_tables", other_tables_data(settings, study)).set("command", "{}", command_line);
  return data;
}

Table coverage_csv(const CoverageStudy& study) {
  Table table({"readout", "klux", "distance_m", "frames", "table", "figure", "truth", "runs", "spread",
               "mean_standard_error", "spread_ratio", "covered", "runs_with_few_outliers", "judged_by",
               "redrawn_spread_ratio", "verdict"});
  for (const CoverageCell& cell : study.cells) {
    const auto number = [](double value) { return fmt::format("{:.6g}", value); };
    table.add({cell.estimator, fmt::format("{:g}", cell.klux), fmt::format("{:g}", cell.distance_m),
               fmt::format("{}", cell.frames), cell.after_table ? "after" : "before",
               std::string(figure_name(cell.figure)), number(cell.truth), fmt::format("{}", cell.seen.runs),
               number(cell.seen.spread), number(cell.seen.mean_standard_error),
               cell.seen.mean_standard_error > 0.0 ? number(cell.seen.spread_ratio()) : "",
               fmt::format("{}", cell.seen.covered), fmt::format("{}", cell.seen.with_few),
               cell.by_spread ? "spread" : "coverage",
               cell.redrawn ? number(cell.redrawn->spread_ratio()) : "",
               std::string(verdict_word(cell.verdict))});
  }
  return table;
}

}  // namespace dtof
