// SPDX-License-Identifier: Apache-2.0
#include "intervals/coverage_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
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

std::string verdict_sentence(const CoverageStudy& study) {
  Group all;
  for (const CoverageCell& cell : study.cells) {
    all.add(cell);
  }
  std::string text = fmt::format(
      "**{} of {} cells hold.** {} are judged by the spread: {} of these lie from {:g} to {:g} at once, {} "
      "when "
      "drawn again.\n{} are judged by the share of intervals that hold the truth: {} of these hold at once, "
      "{} when drawn again.",
      study.cells.size() - static_cast<std::size_t>(all.failed), study.cells.size(), all.by_spread,
      std::ranges::count_if(
          study.cells,
          [](const CoverageCell& c) { return c.by_spread && c.verdict == CoverageVerdict::kHolds; }),
      kLeastSpreadRatio, kMostSpreadRatio, all.redrawn, all.by_coverage,
      std::ranges::count_if(
          study.cells,
          [](const CoverageCell& c) { return !c.by_spread && c.verdict == CoverageVerdict::kHolds; }),
      all.redrawn_coverage);
  return text;
}

std::string by_figure(const CoverageSettings& settings, const CoverageStudy& study) {
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
  return table.markdown();
}

std::string by_readout(const CoverageStudy& study) {
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
  return table.markdown();
}

std::string covered(const RunStatistics& statistics) {
  return fmt::format("{} of {}", statistics.covered, statistics.runs);
}

std::string exceptions(const CoverageStudy& study) {
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
  return table.markdown();
}

std::string tables_section(const CoverageSettings& settings, const CoverageStudy& study) {
  if (study.tables.empty()) {
    return {};
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
  return fmt::format(
      "## What another calibration run would change\n\n"
      "All figures after the table are from calibration run {}: {} frames at every {:g} m. Here the "
      "tables of {} other runs correct the same frames. The table shows the spread of the figures over "
      "these tables, in standard errors reported with {} frames. The intervals do not include this "
      "spread: they are for one calibrated sensor.\n\n{}\n",
      settings.study.calibration_seed, settings.study.calibration_frames, settings.study.calibration_step_m,
      settings.other_calibrations, study.tables.front().frames, table.markdown());
}

std::string stopping_section(const CoverageSettings& settings, const CoverageStudy& study) {
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
  return fmt::format(
      "## --precision: is the true error reached where it stops?\n\nThe figures of each seed are "
      "judged after {}, twice, four times as many frames and so on, up to {}. A run stops when both "
      "intervals are within the precision, and when the run has ten outliers, or none in so many "
      "frames that outliers are rarer than {:g} %; the figures are then those without outliers. Right: "
      "the figure is as near to the truth as requested. A place and read-out fails if its seeds refute "
      "(at 95 %) that 95 % are right.\n\n{}\n{} of {} fail{}\n\n{}",
      settings.frames.front(), settings.frames.back(), settings.study.rare_outliers * 100.0, table.markdown(),
      all_failed, study.stopping.size(), all_failed == 0 ? "." : ":",
      all_failed == 0 ? std::string() : failures.markdown() + "\n");
}

}  // namespace

std::size_t coverage_failures(const CoverageStudy& study) {
  const auto cells =
      std::ranges::count(study.cells, CoverageVerdict::kFails, &CoverageCell::verdict) +
      std::ranges::count_if(study.stopping, [](const StoppingCell& cell) { return !cell.holds(); });
  return static_cast<std::size_t>(cells);
}

std::string coverage_report(const CoverageSettings& settings, const CoverageStudy& study,
                            const std::string& command_line) {
  const auto outside = std::ranges::count_if(
      study.cells, [](const CoverageCell& cell) { return cell.verdict != CoverageVerdict::kHolds; });
  return fmt::format(
             "# Do the intervals hold?\n\n"
             "Do the 95 % intervals that `dtof-study accuracy` and `dtof-study reproduce` print agree "
             "with repeated runs? {} seeds from {} on, {} frames each, at {} klux and {} m. All "
             "read-outs see the same photons. Shorter runs are parts of the long ones ({} runs of {} "
             "frames). Preset {}, calibration run {}. The truth is the figure over all {} frames.\n\nA "
             "cell is one figure of one read-out at one place with one number of frames. A cell holds "
             "if the spread of the figure over runs is {:g} to {:g} times the mean of the reported "
             "standard errors (about a quarter of the interval's width). {} runs leave this ratio "
             "uncertain by about {:.0f} %. If their ratio lies outside, {} runs drawn with replacement "
             "from all frames decide. If a few outliers make the spread (more than half of the runs "
             "report fewer than ten outliers, but all frames together have some), the spread proves "
             "nothing. The cell then holds if the share of intervals that hold the truth does not "
             "refute 95 %. The seeds' runs refute one in 40 of the cells whose intervals are right; "
             "for these cells, too, the drawn runs decide.\n\n{}\n\n"
             "Extremes over places and read-outs; in brackets the number of cells:\n\n{}\n"
             "The same for each read-out, over places and numbers of frames:\n\n{}\n",
             settings.seeds, settings.study.run.seed, settings.frames.back(), fmt::join(settings.klux, ", "),
             fmt::join(settings.distances_m, ", "),
             settings.seeds * (settings.frames.back() / settings.frames.front()), settings.frames.front(),
             settings.study.sensor.name, settings.study.calibration_seed,
             settings.seeds * settings.frames.back(), kLeastSpreadRatio, kMostSpreadRatio, settings.seeds,
             100.0 / std::sqrt(2.0 * (settings.seeds - 1)), kRedrawnRuns, verdict_sentence(study),
             by_figure(settings, study), by_readout(study)) +
         (outside == 0
              ? std::string("No cell lies outside.\n\n")
              : fmt::format("Cells that lie outside with the seeds' own runs:\n\n{}\n", exceptions(study))) +
         stopping_section(settings, study) + tables_section(settings, study) +
         fmt::format("Command: `{}`\n", command_line);
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
