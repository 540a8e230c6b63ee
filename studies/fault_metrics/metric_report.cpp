// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/metric_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
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

// Rows, columns, acquisitions, faults, command, seed, conclusions, and the tables.
constexpr std::string_view kPage = R"(# Fault metrics

Which single faults in logic and SRAM make a result wrong, and which of them the protection detects within one frame. Netlists of
small arrays ({} columns of {} pixels) receive {} acquisitions of the scene `room`, preset `thesis`, 14 klux. Up to {} faults are
drawn for each life of a fault and each kind of element of each part. Command: `{}`, seed {}.

{}
* **Single event**: a flip-flop or a stored bit changes its state in one random clock, or the output of a gate is inverted for one clock.
* **Stuck-at**: the output of a gate or a flip-flop, a data output of an SRAM, or a stored bit is 0, or 1, in every clock.
* **Harmful**: a word of the result stream is wrong, missing or too much, or the frame does not end within an eighth more than its clocks. A word
  is wrong if one of its bits differs from the frame without a fault, the confidence included.
* **Detected**: in the frame by `parity_error_o`, by `error_o`, or by what the receiver finds (a missing or surplus result, a result with
  the row or column of another pixel, no end of the frame). A stuck-at fault is also detected if the frame of the self-test has another result.
  "Beyond 3 %" are harmful faults that move the position of a pixel by more than 3 %, or lose a pixel.
* **Single-point fault metric** (SPFM) and **latent fault metric** (LFM) are those of ISO 26262-5, annex C:
  SPFM = 1 - undetected harmful faults / all faults; LFM = 1 - latent faults / (all faults - undetected harmful faults). A latent fault is
  harmless, found neither by the frame nor by the self-test, and hides one of the flipped bits that parity otherwise detects. A flip of each SRAM
  is tried.
* **Weights**: every gate, flip-flop and stored bit has the same fault rate. Shares are those of an array of {} columns of {} pixels: elements
  of columns count {} times per column of the small array, stored bits in proportion to the pixels, and the control once.
* **Not in the netlist**: TDCs, clock and reset trees, delays, bridges between wires, and what surrounds the array in `dtof_subsystem`. A fault
  of two bits of a word, which parity does not detect, is no single fault.
* In brackets: 95 % intervals (Wilson's, with the number of faults that would have the same variance in one stratum).

## Metrics

Detected: share of the harmful faults that are detected, of all, of those in gates and flip-flops, and of those beyond 3 %.

{}
## Detected by

Harmful faults by the first means that detects them, in %.

{}
## Parts

Arrays with parity. Elements: of the full array. Undetected: share of all undetected harmful faults of this life, in %.

{}
## Cost of parity

Area, power at 330 MHz (typical corner, stated activity) and highest clock in the slow corner are those of [area](area.md) and
[timing](timing.md). Clocks of a frame are those of the small arrays. A "-" is a configuration that is not synthesised.

{})";

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

std::string metric_table(std::span<const ArrayResult> results) {
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
  return table.markdown();
}

std::string means_table(std::span<const ArrayResult> results) {
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
  return table.markdown();
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

std::string part_table(std::span<const ArrayResult> results) {
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
  return table.markdown();
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

std::string cost_table(std::span<const ArrayResult> results,
                       const std::map<std::string, ProtectionCost>& costs) {
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
  return table.markdown();
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

std::string verdict(const Estimate& detected) {
  if (std::isnan(detected.value)) {
    return "no fault was harmful";
  }
  const std::string_view met = detected.interval.low >= kDetectedGoal ? "the goal is met"
                               : detected.interval.high < kDetectedGoal
                                   ? "the goal is missed"
                                   : "the interval does not decide whether the goal is met";
  return fmt::format("{} %, {}", percent(detected), met);
}

std::string conclude(std::span<const ArrayResult> results,
                     const std::map<std::string, ProtectionCost>& costs) {
  std::string text = fmt::format(
      "Goals: at least {:.0f} % of the harmful single faults are detected within one "
      "frame; parity takes at most {:.0f} % of the area.\n\n",
      kPercent * kDetectedGoal, kPercent * kAreaGoal);
  for (const ArrayResult& result : results) {
    if (!result.parity) {
      continue;
    }
    for (const FaultLife life : kLives) {
      const SafetyMetrics metrics = safety_metrics(result, life);
      text +=
          fmt::format("* {} with parity, {}: detected harmful faults {}; of those in logic {} %.",
                      title(result), life_title(life), verdict(metrics.detected), percent(metrics.in_logic));
      if (undetected_sum(result.strata, life) > 0.0) {
        text += fmt::format(" Most of the others: {}.", largest_classes(result, life));
      }
      if (life == FaultLife::kStuck) {
        text += fmt::format(" Without the self-test, {} % are detected.", percent(metrics.in_frame));
      }
      text += '\n';
    }
    const auto cost = costs.find(result.readout);
    if (cost == costs.end()) {
      text += fmt::format("* {}: the array with parity is not synthesised.\n", title(result));
    } else {
      const double share = cost->second.area_share();
      text += fmt::format("* {}: parity takes {} % of the area, the goal is {}.\n", title(result),
                          percent(share), share <= kAreaGoal ? "met" : "missed");
    }
  }
  return text;
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
  MetricReport report;
  report.conclusions = conclude(results, costs);
  const int columns = results.empty() ? 0 : results.front().columns;
  const int rows = results.empty() ? 0 : results.front().rows;
  report.markdown = fmt::format(kPage, columns, rows, options.acquisitions, options.faults, command_line,
                                options.seed, report.conclusions, kFullColumns, kFullRows,
                                columns == 0 ? 0 : kFullColumns / columns, metric_table(results),
                                means_table(results), part_table(results), cost_table(results, costs));
  report.csv = csv_of(results);
  return report;
}

}  // namespace dtof
