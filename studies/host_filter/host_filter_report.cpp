// SPDX-License-Identifier: Apache-2.0
#include "host_filter/host_filter_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "dtof/frame/flat_calibration.hpp"

namespace dtof {
namespace {

std::string share_text(const Estimate& share) {
  return fmt::format("{:.2f} +-{:.2f}", 100.0 * share.value,
                     50.0 * (share.interval.high - share.interval.low));
}

/// Above 3 % of each scene, before / after.
Table filter_scene_table(const FilterLight& light) {
  std::vector<std::string> header = {"scene"};
  header.insert(header.end(), light.estimators().begin(), light.estimators().end());
  Table table(std::move(header));
  for (std::size_t s = 0; s < light.scenes().size(); ++s) {
    std::vector<std::string> row = {light.scenes()[s]};
    for (std::size_t e = 0; e < light.estimators().size(); ++e) {
      const std::size_t one[] = {s};
      row.push_back(fmt::format("{:.2f} / {:.2f}", 100.0 * light.estimate(one, e, false, 0).value,
                                100.0 * light.estimate(one, e, true, 0).value));
    }
    table.add(std::move(row));
  }
  return table;
}

Table filter_goal_table(const std::vector<FilterLight>& whole) {
  Table table({"goal", "without", "with the filter", "limit", "met"});
  for (const FilterLight& light : whole) {
    const std::vector<std::size_t> all = light.all_scenes();
    const Estimate after = light.estimate(all, 0, true, 0);
    table.add({fmt::format("{}: {:g} klux, above 3 %", light.estimators().front(), light.klux()),
               share_text(light.estimate(all, 0, false, 0)), share_text(after),
               fmt::format("{:.2f}", 100.0 * kFilterGoal), goal_verdict(after, kFilterGoal)});
  }
  return table;
}

void add_filter_rows(Table& csv, const char* part, const FilterLight& light) {
  for (std::size_t s = 0; s < light.scenes().size(); ++s) {
    const std::size_t one[] = {s};
    for (std::size_t e = 0; e < light.estimators().size(); ++e) {
      for (const bool filtered : {false, true}) {
        std::vector<std::string> row = {part,
                                        light.scenes()[s],
                                        light.estimators()[e],
                                        filtered ? "after" : "before",
                                        fmt::format("{:g}", light.klux()),
                                        fmt::format("{}", light.pixels(one, 0))};
        for (std::size_t f = 0; f < kFilterFigures.size(); ++f) {
          if (light.pixels(one, f) == 0) {
            row.insert(row.end(), 3, "");
            continue;
          }
          const Estimate share = light.estimate(one, e, filtered, f);
          for (const double value : {share.value, share.interval.low, share.interval.high}) {
            row.push_back(fmt::format("{:.6f}", value));
          }
        }
        csv.add(std::move(row));
      }
    }
  }
}

}  // namespace

const char* goal_verdict(const Estimate& share, double limit) {
  if (share.interval.high < limit) {
    return "yes";
  }
  return share.interval.low > limit ? "**no**" : "open";
}

Table host_filter_table(const FilterLight& light) {
  std::vector<std::string> header = {"read-out"};
  for (const FilterFigure& figure : kFilterFigures) {
    header.push_back(fmt::format("{}: before", figure.title));
    header.emplace_back("after");
  }
  Table table(std::move(header));
  const std::vector<std::size_t> all = light.all_scenes();
  for (std::size_t e = 0; e < light.estimators().size(); ++e) {
    std::vector<std::string> row = {light.estimators()[e]};
    for (std::size_t f = 0; f < kFilterFigures.size(); ++f) {
      for (const bool filtered : {false, true}) {
        row.push_back(light.pixels(all, f) == 0 ? "-" : share_text(light.estimate(all, e, filtered, f)));
      }
    }
    table.add(std::move(row));
  }
  return table;
}

PageData host_filter_page(const HostFilterReport& report) {
  const HostFilterSettings& settings = report.settings;
  std::optional<PageData> goal;
  if (!report.whole.empty()) {
    goal = PageData().set("verdicts", filter_goal_table(report.whole));
  }
  std::vector<PageData> lights;
  for (const FilterLight& light : report.lights) {
    lights.push_back(PageData()
                         .set("klux", "{:g}", light.klux())
                         .set("all_scenes", host_filter_table(light))
                         .set("each_scene", filter_scene_table(light)));
  }
  PageData data;
  data.set("sensor", "{}", settings.sensor.name)
      .set("columns", "{}", settings.columns)
      .set("first_seed", "{}", settings.seed)
      .set("last_seed", "{}", settings.seed + static_cast<std::uint64_t>(settings.seeds) - 1)
      .set("look_up_tables", "{}", table_sentence(TableRule::kFlat, settings.sensor, settings.seed))
      .set("command", "{}", report.command_line)
      .part("goal", std::move(goal))
      .list("lights", std::move(lights));
  return data;
}

Table host_filter_csv(const HostFilterReport& report) {
  std::vector<std::string> header = {"part", "scene", "estimator", "filter", "klux", "pixels"};
  for (const FilterFigure& figure : kFilterFigures) {
    for (const char* suffix : {"", "_low", "_high"}) {
      header.push_back(std::string(figure.column) + suffix);
    }
  }
  Table csv(std::move(header), 4);
  for (const FilterLight& light : report.lights) {
    add_filter_rows(csv, "middle", light);
  }
  for (const FilterLight& light : report.whole) {
    add_filter_rows(csv, "whole", light);
  }
  return csv;
}

std::vector<PlotSeries> host_filter_curves(const HostFilterReport& report) {
  std::vector<PlotSeries> curves;
  if (report.lights.size() < 2) {
    return curves;
  }
  const std::vector<std::string>& estimators = report.lights.front().estimators();
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    for (const bool filtered : {false, true}) {
      PlotSeries curve{estimators[e] + (filtered ? ", filtered" : ""), {}, {}};
      for (const FilterLight& light : report.lights) {
        curve.x.push_back(light.klux());
        curve.y.push_back(100.0 * light.estimate(light.all_scenes(), e, filtered, 0).value);
      }
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace dtof
