// SPDX-License-Identifier: Apache-2.0
#include "dynamic_range/dynamic_range_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "common/engine_frame.hpp"
#include "common/percent_text.hpp"
#include "dtof/frame/flat_calibration.hpp"

namespace dtof {
namespace {

/// A page stays short; the data has every cell.
constexpr std::size_t kMostListed = 20;
constexpr std::array kShown = {Readout::kPoolPointer, Readout::kPoolPointerLean, Readout::kCoarseHistogram,
                               Readout::kHisPointer, Readout::kEzPointer};

std::string title_of(const std::string& name) { return std::string(readout_title(parse_readout(name))); }

std::string with_interval(const Estimate& share) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", 100.0 * share.value, 100.0 * share.interval.low,
                     100.0 * share.interval.high);
}

std::size_t count_of(const std::vector<RangeFinding>& findings, std::string_view readout) {
  return static_cast<std::size_t>(std::ranges::count(findings, readout, &RangeFinding::readout));
}

std::size_t of_pool(const std::vector<RangeFinding>& findings) {
  return static_cast<std::size_t>(std::ranges::count_if(findings, about_pool_readout));
}

/// The findings about pool read-outs, the largest differences first; nothing if there is none.
std::optional<PageData> pool_findings_data(const std::vector<RangeFinding>& findings,
                                           std::string (*better)(const RangeFinding&)) {
  std::vector<RangeFinding> pool;
  std::ranges::copy_if(findings, std::back_inserter(pool), about_pool_readout);
  if (pool.empty()) {
    return std::nullopt;
  }
  std::ranges::stable_sort(pool, std::greater<>(), [](const RangeFinding& finding) {
    return finding.share.value - finding.better_share.value;
  });
  Table table(
      {"read-out", "errors above", "signal", "klux", "acquisitions", "pixels, %", "better", "pixels, %"});
  for (std::size_t i = 0; i < std::min(pool.size(), kMostListed); ++i) {
    const RangeFinding& finding = pool[i];
    table.add({title_of(finding.readout), fmt::format("{} %", finding.limit_percent),
               fmt::format("x {:g}", finding.cell.signal), fmt::format("{:g}", finding.cell.klux),
               fmt::format("{}", finding.cell.acquisitions), with_interval(finding.share), better(finding),
               with_interval(finding.better_share)});
  }
  PageData data;
  data.set("findings", table);
  std::optional<PageData> left_out;
  if (pool.size() > kMostListed) {
    left_out = PageData().set("number", "{}", pool.size() - kMostListed);
  }
  data.part("left_out", std::move(left_out));
  return data;
}

Table counts_table(const RangeSettings& settings, const DynamicRange& study) {
  Table table({"read-out", "more acquisitions, > 3 %", "> 10 %", "more signal, > 3 %", "> 10 %"});
  for (const ReadoutParameters& readout : settings.readouts) {
    std::vector<std::string> row = {std::string(readout_title(readout.readout))};
    for (const auto* const findings : {&study.more_acquisitions, &study.more_signal}) {
      for (const int percent : {3, 10}) {
        row.push_back(fmt::format("{}", std::ranges::count_if(*findings, [&](const RangeFinding& finding) {
                                    return finding.readout == readout_name(readout.readout) &&
                                           finding.limit_percent == percent;
                                  })));
      }
    }
    table.add(std::move(row));
  }
  return table;
}

Table signal_table(const RangeSettings& settings, const DynamicRange& study, double signal) {
  std::vector<std::string> header = {"read-out", "klux"};
  for (const std::uint32_t acquisitions : settings.acquisitions) {
    header.push_back(fmt::format("{}", acquisitions));
  }
  Table table(std::move(header));
  for (const Readout readout : kShown) {
    const std::string name(readout_name(readout));
    for (const double klux : settings.klux) {
      std::vector<std::string> row = {std::string(readout_title(readout)), fmt::format("{:g}", klux)};
      for (const std::uint32_t acquisitions : settings.acquisitions) {
        const RangeReadouts& readouts = study.grid.at({signal, klux, acquisitions});
        const auto found = readouts.find(name);
        row.push_back(
            found == readouts.end()
                ? "-"
                : fmt::format(
                      "{} / {}",
                      percent_text(range_share(found->second, &RangeCounts::above_3_percent).value),
                      percent_text(range_share(found->second, &RangeCounts::above_10_percent).value)));
      }
      if (study.grid.begin()->second.contains(name)) {
        table.add(std::move(row));
      }
    }
  }
  return table;
}

RangeCounts sum_of(const std::vector<RangeCounts>& seeds) {
  RangeCounts sum;
  for (const RangeCounts& counts : seeds) {
    sum.pixels += counts.pixels;
    sum.full += counts.full;
    sum.full_above_3_percent += counts.full_above_3_percent;
    sum.above_3_percent += counts.above_3_percent;
    sum.above_10_percent += counts.above_10_percent;
    sum.changed += counts.changed;
    sum.wide_above_3_percent += counts.wide_above_3_percent;
    sum.wide_above_10_percent += counts.wide_above_10_percent;
  }
  return sum;
}

std::string share_or_dash(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? "-" : percent_text(static_cast<double>(part) / static_cast<double>(whole));
}

/// Whether full counters cost the read-out more than the intervals of both explain.
bool harmed(const std::vector<RangeCounts>& seeds) {
  return range_share(seeds, &RangeCounts::above_10_percent).interval.low >
         range_share(seeds, &RangeCounts::wide_above_10_percent).interval.high;
}

PageData full_counters_data(const RangeSettings& settings, const DynamicRange& study) {
  Table table({"read-out", "signal", "acquisitions", "klux", "full", "> 3 % of these", "of the others",
               "moved", "> 3 / 10 %", "with 16 bits"});
  std::vector<std::string> wrong;
  for (const ReadoutParameters& readout : settings.readouts) {
    const std::string name(readout_name(readout.readout));
    std::vector<std::string> where;
    for (const auto& [cell, readouts] : study.full) {
      const auto found = readouts.find(name);
      if (found == readouts.end()) {
        continue;
      }
      const RangeCounts sum = sum_of(found->second);
      if (harmed(found->second)) {
        where.push_back(fmt::format("{:g} klux x {:g}", cell.klux, cell.signal));
      }
      if (sum.changed == 0) {
        continue;
      }
      table.add({std::string(readout_title(readout.readout)), fmt::format("x {:g}", cell.signal),
                 fmt::format("{}", cell.acquisitions), fmt::format("{:g}", cell.klux),
                 share_or_dash(sum.full, sum.pixels), share_or_dash(sum.full_above_3_percent, sum.full),
                 share_or_dash(sum.above_3_percent - sum.full_above_3_percent, sum.pixels - sum.full),
                 share_or_dash(sum.changed, sum.pixels),
                 fmt::format("{} / {}", share_or_dash(sum.above_3_percent, sum.pixels),
                             share_or_dash(sum.above_10_percent, sum.pixels)),
                 fmt::format("{} / {}", share_or_dash(sum.wide_above_3_percent, sum.pixels),
                             share_or_dash(sum.wide_above_10_percent, sum.pixels))});
    }
    if (!where.empty()) {
      wrong.push_back(fmt::format("{} ({})", readout_title(readout.readout), fmt::join(where, ", ")));
    }
  }
  PageData data;
  std::optional<PageData> harmed_cells;
  if (!wrong.empty()) {
    harmed_cells = PageData().set("where", "{}", fmt::join(wrong, "; "));
  }
  data.part("harmed", std::move(harmed_cells)).set("moved", table);
  return data;
}

std::string better_acquisitions(const RangeFinding& finding) {
  return fmt::format("{} acquisitions", finding.better_cell.acquisitions);
}
std::string better_signal(const RangeFinding& finding) {
  return fmt::format("signal x {:g}", finding.better_cell.signal);
}
std::string better_readout(const RangeFinding& finding) { return title_of(finding.better_readout); }

/// "poolPointer: 3 entries, poolPointer lean: 1 entry".
std::string of_each(const RangeSettings& settings, const std::vector<RangeFinding>& findings) {
  std::vector<std::string> texts;
  for (const ReadoutParameters& readout : settings.readouts) {
    if (is_pool_readout(readout.readout)) {
      const std::size_t count = count_of(findings, readout_name(readout.readout));
      texts.push_back(
          fmt::format("{}: {} {}", readout_title(readout.readout), count, count == 1 ? "entry" : "entries"));
    }
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string scene_names(const RangeSettings& settings) {
  std::vector<std::string_view> names;
  for (const Scene scene : settings.scenes) {
    names.push_back(scene_name(scene));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::size_t pool_findings(const DynamicRange& study) {
  return of_pool(study.more_acquisitions) + of_pool(study.more_signal) + of_pool(study.behind);
}

double pictured_klux(const RangeSettings& settings) {
  std::vector<double> klux = settings.klux;
  std::ranges::sort(klux);
  return klux[klux.size() / 2];
}

std::vector<PlotSeries> dynamic_range_curves(const RangeSettings& settings, const DynamicRange& study) {
  const double signal =
      std::ranges::min(settings.signals, {}, [](double value) { return std::abs(std::log(value)); });
  std::vector<PlotSeries> series;
  for (const ReadoutParameters& readout : settings.readouts) {
    PlotSeries line{std::string(readout_title(readout.readout)), {}, {}};
    for (const std::uint32_t acquisitions : settings.acquisitions) {
      const RangeReadouts& readouts = study.grid.at({signal, pictured_klux(settings), acquisitions});
      const Estimate share =
          range_share(readouts.at(std::string(readout_name(readout.readout))), &RangeCounts::above_3_percent);
      line.x.push_back(acquisitions);
      line.y.push_back(100.0 * share.value);
    }
    series.push_back(std::move(line));
  }
  return series;
}

Table dynamic_range_csv(const DynamicRange& study) {
  Table table({"readout", "part", "signal", "klux", "acquisitions", "pixels", "above_3_percent",
               "above_3_low", "above_3_high", "above_10_percent", "above_10_low", "above_10_high", "full",
               "full_above_3_percent", "changed_by_full", "wide_above_3_percent", "wide_above_10_percent"});
  const auto add = [&](const char* part, const RangeResults& results) {
    for (const auto& [cell, readouts] : results) {
      for (const auto& [readout, seeds] : readouts) {
        const RangeCounts sum = sum_of(seeds);
        const Estimate three = range_share(seeds, &RangeCounts::above_3_percent);
        const Estimate ten = range_share(seeds, &RangeCounts::above_10_percent);
        std::vector<std::string> row = {readout,
                                        part,
                                        fmt::format("{:g}", cell.signal),
                                        fmt::format("{:g}", cell.klux),
                                        fmt::format("{}", cell.acquisitions),
                                        fmt::format("{}", sum.pixels)};
        for (const Estimate& share : {three, ten}) {
          for (const double value : {share.value, share.interval.low, share.interval.high}) {
            row.push_back(fmt::format("{:.6g}", value));
          }
        }
        for (const std::uint64_t count : {sum.full, sum.full_above_3_percent, sum.changed,
                                          sum.wide_above_3_percent, sum.wide_above_10_percent}) {
          row.push_back(fmt::format("{}", count));
        }
        table.add(std::move(row));
      }
    }
  };
  add("grid", study.grid);
  add("full_counters", study.full);
  return table;
}

PageData dynamic_range_page(const RangeSettings& settings, const DynamicRange& study,
                            const std::string& command_line) {
  PageData data;
  data.set("readouts", "{}", settings.readouts.size())
      .set("least_acquisitions", "{}", std::ranges::min(settings.acquisitions))
      .set("most_acquisitions", "{}", std::ranges::max(settings.acquisitions))
      .set("least_klux", "{:g}", std::ranges::min(settings.klux))
      .set("most_klux", "{:g}", std::ranges::max(settings.klux))
      .set("least_signal", "{:g}", std::ranges::min(settings.signals))
      .set("most_signal", "{:g}", std::ranges::max(settings.signals))
      .set("sensor", "{}", settings.sensor.name)
      .set("cells", "{}", study.grid.size())
      .set("more_acquisitions_entries", "{}", of_each(settings, study.more_acquisitions))
      .set("more_signal_entries", "{}", of_each(settings, study.more_signal))
      .set("many_acquisitions", "{}", kManyAcquisitions)
      .set("behind_entries", "{}", of_each(settings, study.behind))
      .set("unconfirmed", "{}", study.unconfirmed)
      .flag("one_unconfirmed", study.unconfirmed == 1)
      .part("more_acquisitions", pool_findings_data(study.more_acquisitions, better_acquisitions))
      .part("more_signal", pool_findings_data(study.more_signal, better_signal))
      .part("behind", pool_findings_data(study.behind, better_readout))
      .set("entries_of_readouts", counts_table(settings, study));
  std::vector<PageData> signals;
  for (const double signal : settings.signals) {
    signals.push_back(
        PageData().set("signal", "{:g}", signal).set("errors", signal_table(settings, study, signal)));
  }
  data.list("signals", std::move(signals));
  std::optional<PageData> full;
  if (!study.full.empty()) {
    full = full_counters_data(settings, study);
  }
  data.part("full_counters", std::move(full))
      .set("scenes", "{}", scene_names(settings))
      .set("columns_read", "{}", engine_columns_read())
      .set("rows", "{}", settings.rows)
      .set("sensor_columns", "{}", settings.sensor.columns)
      .set("sensor_rows", "{}", settings.sensor.rows)
      .set("columns_judged", "{}", engine_columns_judged())
      .set("seeds", "{}", settings.seeds)
      .set("seed", "{}", settings.seed)
      .set("pixels", "{}", sum_of(study.grid.begin()->second.begin()->second).pixels)
      .set("table_pixels", "{}", FlatCalibration::kPixels)
      .set("command", "{}", command_line);
  return data;
}

}  // namespace dtof
