// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/metric_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "dtof/core/readout.hpp"
#include "dtof/report/table.hpp"
#include "fault_metrics/safety_metrics.hpp"

namespace dtof {
namespace {

constexpr double kPercent = 100.0;
constexpr std::array kLives = {FaultLife::kEvent, FaultLife::kStuck};
constexpr std::size_t kLargestClasses = 3;

std::string title(const ArrayResult& result) {
  return std::string(readout_title(parse_readout(result.readout)));
}
std::string_view life_title(FaultLife life) {
  return life == FaultLife::kEvent ? "single event" : "stuck-at";
}
std::string yes(bool value) { return value ? "yes" : "no"; }

std::string percent(double share) {
  return std::isnan(share) ? "-" : fmt::format("{:.2f}", kPercent * share);
}
std::string percent(const Estimate& share) {
  if (std::isnan(share.value)) {
    return "-";
  }
  return fmt::format("{} ({} to {})", percent(share.value), percent(share.interval.low),
                     percent(share.interval.high));
}

Table metric_table(std::span<const ArrayResult> results) {
  Table table({"read-out", "parity", "fault", "harmful, %", "detected of them, %", "of those in logic, %",
               "beyond 3 %, %", "SPFM, %", "LFM, %"},
              3);
  for (const ArrayResult& result : results) {
    for (const FaultLife life : kLives) {
      const SafetyMetrics metrics = safety_metrics(result, life);
      const bool has_latent = result.parity && life == FaultLife::kStuck;
      table.add({title(result), yes(result.parity), std::string(life_title(life)), percent(metrics.harmful),
                 percent(metrics.detected), percent(metrics.in_logic), percent(metrics.detected_beyond),
                 percent(metrics.single_point), has_latent ? percent(metrics.latent) : "-"});
    }
  }
  return table;
}

Table means_table(std::span<const ArrayResult> results) {
  Table table(
      {"read-out", "parity", "fault", "parity_error_o", "error_o", "receiver", "self-test", "nothing"}, 3);
  for (const ArrayResult& result : results) {
    for (const FaultLife life : kLives) {
      const double harmful =
          weighted_sum(result.strata, life, [](const FaultCounts& c) { return c.harmful; });
      const auto share = [&](const Counted& part) {
        return percent(weighted_sum(result.strata, life, part) / harmful);
      };
      table.add({title(result), yes(result.parity), std::string(life_title(life)),
                 share([](const FaultCounts& c) { return c.by_parity; }),
                 share([](const FaultCounts& c) { return c.by_protocol; }),
                 share([](const FaultCounts& c) { return c.by_frame_check; }),
                 life == FaultLife::kStuck ? share([](const FaultCounts& c) { return c.by_self_test; }) : "-",
                 share([](const FaultCounts& c) { return c.undetected; })});
    }
  }
  return table;
}

/// Strata of one part and one kind of element.
struct ElementClass {
  CircuitPart part;
  Element element;
  std::vector<StratumResult> strata;

  [[nodiscard]] std::string name() const {
    return element == Element::kBit ? std::string(part_title(part))
                                    : fmt::format("{} of {}", element_title(element), part_title(part));
  }
};

std::vector<ElementClass> classes_of(const ArrayResult& result) {
  std::vector<ElementClass> classes;
  for (const StratumResult& stratum : result.strata) {
    if (classes.empty() || classes.back().part != stratum.part || classes.back().element != stratum.element) {
      classes.push_back({stratum.part, stratum.element, {}});
    }
    classes.back().strata.push_back(stratum);
  }
  return classes;
}

double undetected_sum(std::span<const StratumResult> strata, FaultLife life) {
  return weighted_sum(strata, life, [](const FaultCounts& c) { return c.undetected; });
}

Table part_table(std::span<const ArrayResult> results) {
  Table table({"read-out", "part", "elements", "single events: harmful, %", "detected, %", "undetected, %",
               "stuck-at: harmful, %", "detected, %", "undetected, %", "latent, %"},
              2);
  for (const ArrayResult& result : results) {
    if (!result.parity) {
      continue;
    }
    for (const ElementClass& one : classes_of(result)) {
      double elements = 0.0;
      for (const StratumResult& stratum : one.strata) {
        elements += stratum.full_sites;
      }
      std::vector<std::string> cells = {title(result), one.name(), fmt::format("{:.0f}", elements)};
      for (const FaultLife life : kLives) {
        const auto all = [](const FaultCounts& c) { return c.faults; };
        const auto harmful = [](const FaultCounts& c) { return c.harmful; };
        const auto found = [](const FaultCounts& c) { return c.harmful - c.undetected; };
        cells.push_back(percent(weighted_share(one.strata, life, harmful, all).value));
        cells.push_back(percent(weighted_share(one.strata, life, found, harmful).value));
        cells.push_back(percent(undetected_sum(one.strata, life) / undetected_sum(result.strata, life)));
      }
      cells.push_back(
          percent(weighted_share(
                      one.strata, FaultLife::kStuck, [](const FaultCounts& c) { return c.latent; },
                      [](const FaultCounts& c) { return c.faults; })
                      .value));
      table.add(cells);
    }
  }
  return table;
}

std::string pair_text(double without, double with, int digits) {
  return fmt::format("{:.{}f} / {:.{}f}", without, digits, with, digits);
}

/// The array of the same read-out without parity.
const ArrayResult* without_parity(std::span<const ArrayResult> results, const ArrayResult& with) {
  const auto found = std::ranges::find_if(
      results, [&](const ArrayResult& one) { return one.readout == with.readout && !one.parity; });
  return found == results.end() ? nullptr : &*found;
}

Table cost_table(std::span<const ArrayResult> results, const std::map<std::string, ProtectionCost>& costs) {
  Table table({"read-out", "mm2 without / with", "more, %", "mW without / with", "MHz without / with",
               "clocks of a frame without / with"});
  for (const ArrayResult& result : results) {
    const ArrayResult* without = without_parity(results, result);
    if (!result.parity || without == nullptr) {
      continue;
    }
    const auto found = costs.find(result.readout);
    std::vector<std::string> cells = {title(result), "-", "-", "-", "-"};
    if (found != costs.end()) {
      const ProtectionCost& cost = found->second;
      cells = {title(result), pair_text(cost.without.mm2, cost.with.mm2, 3), percent(cost.area_share()),
               pair_text(cost.without.mw, cost.with.mw, 1),
               pair_text(cost.without.fmax_mhz, cost.with.fmax_mhz, 0)};
    }
    cells.push_back(fmt::format("{} / {}", without->clocks, result.clocks));
    table.add(cells);
  }
  return table;
}

/// "gates of columns (61 %), ..." of the classes with most undetected harm.
std::string largest_classes(const ArrayResult& result, FaultLife life) {
  const double all = undetected_sum(result.strata, life);
  std::vector<std::pair<double, std::string>> classes;
  for (const ElementClass& one : classes_of(result)) {
    const double share = undetected_sum(one.strata, life) / all;
    if (share > 0.0) {
      classes.emplace_back(share, fmt::format("{} ({:.0f} %)", one.name(), kPercent * share));
    }
  }
  std::ranges::stable_sort(classes, std::greater<>(), &std::pair<double, std::string>::first);
  std::string text;
  for (std::size_t i = 0; i < std::min(classes.size(), kLargestClasses); ++i) {
    text += (i == 0 ? "" : ", ") + classes[i].second;
  }
  return text;
}

/// The share of detected faults and whether it meets the goal; nothing if no fault was harmful.
std::optional<PageData> verdict_data(const Estimate& detected) {
  if (std::isnan(detected.value)) {
    return std::nullopt;
  }
  const bool met = detected.interval.low >= kDetectedGoal;
  const bool missed = detected.interval.high < kDetectedGoal;
  PageData data;
  data.set("detected", "{}", percent(detected))
      .flag("met", met)
      .flag("missed", missed)
      .flag("undecided", !met && !missed);
  return data;
}

PageData life_data(const ArrayResult& result, FaultLife life) {
  const SafetyMetrics metrics = safety_metrics(result, life);
  std::optional<PageData> undetected;
  if (undetected_sum(result.strata, life) > 0.0) {
    undetected = PageData().set("largest_parts", "{}", largest_classes(result, life));
  }
  std::optional<PageData> stuck;
  if (life == FaultLife::kStuck) {
    stuck = PageData().set("in_frame", "{}", percent(metrics.in_frame));
  }
  PageData data;
  data.set("life", "{}", life_title(life))
      .part("harmful", verdict_data(metrics.detected))
      .set("in_logic", "{}", percent(metrics.in_logic))
      .part("undetected", std::move(undetected))
      .part("stuck", std::move(stuck));
  return data;
}

/// What the page concludes about each array with parity.
std::vector<PageData> arrays_data(std::span<const ArrayResult> results,
                                  const std::map<std::string, ProtectionCost>& costs) {
  std::vector<PageData> arrays;
  for (const ArrayResult& result : results) {
    if (!result.parity) {
      continue;
    }
    std::vector<PageData> lives;
    lives.reserve(kLives.size());
    for (const FaultLife life : kLives) {
      lives.push_back(life_data(result, life));
    }
    std::optional<PageData> cost;
    if (const auto found = costs.find(result.readout); found != costs.end()) {
      const double share = found->second.area_share();
      cost = PageData().set("area_share", "{}", percent(share)).flag("kept", share <= kAreaGoal);
    }
    arrays.emplace_back()
        .set("readout", "{}", title(result))
        .list("lives", std::move(lives))
        .part("cost", std::move(cost));
  }
  return arrays;
}

std::string csv_of(std::span<const ArrayResult> results) {
  Table table({"readout", "parity", "part", "element", "repeated", "life", "elements",
               "elements_of_full_array", "faults", "harmful", "beyond_3_percent", "by_parity", "by_error",
               "by_receiver", "by_self_test", "undetected", "undetected_beyond_3_percent", "latent"});
  constexpr std::array<std::string_view, 3> kPlaces = {"column", "engine", "array"};
  for (const ArrayResult& result : results) {
    for (const StratumResult& one : result.strata) {
      for (const FaultLife life : kLives) {
        const FaultCounts& c = counts_of(one, life);
        std::vector<std::string> cells = {result.readout,
                                          result.parity ? "1" : "0",
                                          std::string(part_title(one.part)),
                                          std::string(element_title(one.element)),
                                          std::string(kPlaces[static_cast<std::size_t>(one.repeated)]),
                                          life == FaultLife::kEvent ? "event" : "stuck",
                                          fmt::format("{}", one.sites),
                                          fmt::format("{:.0f}", one.full_sites)};
        for (const std::uint64_t count :
             {c.faults, c.harmful, c.beyond, c.by_parity, c.by_protocol, c.by_frame_check, c.by_self_test,
              c.undetected, c.undetected_beyond, c.latent}) {
          cells.push_back(fmt::format("{}", count));
        }
        table.add(cells);
      }
    }
  }
  return table.csv();
}

}  // namespace

MetricReport report_metrics(std::span<const ArrayResult> results,
                            const std::map<std::string, ProtectionCost>& costs,
                            const MetricStudyOptions& options, const std::string& command_line) {
  const int columns = results.empty() ? 0 : results.front().columns;
  const int rows = results.empty() ? 0 : results.front().rows;
  PageData page;
  page.set("columns", "{}", columns)
      .set("rows", "{}", rows)
      .set("acquisitions", "{}", options.acquisitions)
      .set("faults", "{}", options.faults)
      .set("command", "{}", command_line)
      .set("seed", "{}", options.seed)
      .set("detected_goal", "{:.0f}", kPercent * kDetectedGoal)
      .set("area_goal", "{:.0f}", kPercent * kAreaGoal)
      .list("arrays", arrays_data(results, costs))
      .set("full_columns", "{}", kFullColumns)
      .set("full_rows", "{}", kFullRows)
      .set("column_ratio", "{}", columns == 0 ? 0 : kFullColumns / columns)
      .set("metrics", metric_table(results))
      .set("means", means_table(results))
      .set("parts", part_table(results))
      .set("costs", cost_table(results, costs));
  return {std::move(page), csv_of(results)};
}

}  // namespace dtof
