// SPDX-License-Identifier: Apache-2.0
#include "design/design_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dtof/core/frame_time.hpp"
#include "dtof/core/latency.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

constexpr double kPerCent = 100.0;
constexpr double kMegahertz = 1e-6;
constexpr const char* kNotEstimated = "not estimated";

std::string title_of(const DesignOption& option) {
  return std::string(readout_title(option.candidate.readout()));
}

std::uint64_t latency_clocks(const DesignCandidate& candidate) {
  const ArrayChoice& array = candidate.array;
  return predicted_latency_clocks(array.parameters, array.rows, array.columns);
}

std::string share_text(const Estimate& share) {
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", kPerCent * share.value, kPerCent * share.covering().low,
                     kPerCent * share.covering().high);
}

std::string optional_share(const std::optional<Estimate>& share, int digits) {
  return share ? fmt::format("{:.{}f}", kPerCent * share->value, digits) : "-";
}

/// "1.18 mm2, 160 mW".
std::string cost_text(const DesignRequest& request, const DesignOption& option) {
  return fmt::format("{:.2f} mm2, {:.0f} mW", option.candidate.cost.mm2,
                     option.candidate.mw(request.limits.budget.clock_hz));
}

std::string limits_text(const DesignLimits& limits) {
  std::vector<std::string> parts;
  if (std::isfinite(limits.most_mm2)) {
    parts.push_back(fmt::format("at most {:g} mm2", limits.most_mm2));
  }
  if (std::isfinite(limits.most_mw)) {
    parts.push_back(fmt::format("at most {:g} mW", limits.most_mw));
  }
  parts.push_back(fmt::format("{:g} frames/s at {:g} MHz", limits.budget.frames_per_s,
                              limits.budget.clock_hz * kMegahertz));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Whether an estimate's error could take the option beyond a limit.
bool near_a_limit(const DesignRequest& request, const DesignOption& option) {
  const EstimateErrors& errors = EstimateCoefficients::built_in().errors;
  const DesignLimits& limits = request.limits;
  return option.candidate.cost.mm2 * (1.0 + errors.area) > limits.most_mm2 ||
         option.candidate.mw(limits.budget.clock_hz) * (1.0 + errors.power) > limits.most_mw;
}

std::string errors_text() {
  const EstimateErrors& errors = EstimateCoefficients::built_in().errors;
  return fmt::format(
      "Area, power and clock are estimates by models fitted to synthesised arrays; of arrays that no fit has "
      "seen "
      "they were off by at most {:.1f} % (area), {:.1f} % (power) and {:.1f} % (clock).",
      kPerCent * errors.area, kPerCent * errors.power, kPerCent * errors.fmax);
}

std::string name_of_choice(const DesignRequest& request, const DesignOption& option) {
  const std::string options = product_options(option.candidate.array, request.bench.sensor);
  const std::size_t end = options.find(' ', std::string("--readout ").size());
  const ArrayChoice& array = option.candidate.array;
  return title_of(option) + (end == std::string::npos ? "" : options.substr(end)) +
         (array.arrays > 1
              ? fmt::format(", {} arrays of {} columns", array.arrays, array.columns * array.columns_per_sram)
              : "");
}

/// What the sensor of a product has to be where it is not the whole one.
std::string product_note(const DesignOption& option) {
  const ArrayChoice& array = option.candidate.array;
  return array.arrays > 1 ? fmt::format("  # with columns = {} in the sensor file, {} times",
                                        array.columns * array.columns_per_sram, array.arrays)
                          : "";
}

/// How many frames compared the contenders, and whether that was enough.
std::string contest_text(const DesignResult& result) {
  std::string text;
  if (result.contest_frames > 0) {
    text = fmt::format("; the contenders in up to {} frames", result.contest_frames);
  }
  return text + (result.settled ? ", which settle the choice at 95 %"
                                : ", which do not settle the choice at 95 %: it follows the measured shares");
}

}  // namespace

std::string design_product(const DesignRequest& request, const DesignResult& result,
                           const std::string& sensor_name) {
  const DesignOption& chosen = result.options[*result.recommendation.chosen];
  return fmt::format("dtof product --sensor {} {} --out chip{}", sensor_name,
                     product_options(chosen.candidate.array, request.bench.sensor), product_note(chosen));
}

Table design_rows(const DesignRequest& request, const DesignResult& result) {
  const double clock_hz = request.limits.budget.clock_hz;
  Table table({"read-out", "off by > 3 % in %", "> 10 % in %", "P_d in %", "P_fa in %", "mm2", "mW",
               "fmax MHz", "frames/s", "latency ms", "bits"});
  for (const std::size_t i : result.recommendation.within) {
    const DesignOption& option = result.options[i];
    const LightScore& worst = option.best_known().worst();
    table.add({name_of_choice(request, option), share_text(worst.above_3_percent),
               optional_share(worst.above_10_percent, 2), optional_share(worst.detected, 1),
               optional_share(worst.false_alarms, 2), fmt::format("{:.2f}", option.candidate.cost.mm2),
               fmt::format("{:.0f}", option.candidate.mw(clock_hz)),
               fmt::format("{:.0f}", option.candidate.cost.fmax_mhz),
               fmt::format("{:.1f}", option.candidate.frames_per_s(clock_hz)),
               fmt::format("{:.2f}", 1e3 * static_cast<double>(latency_clocks(option.candidate)) / clock_hz),
               fmt::format("{:g}", option.candidate.cost.bits_per_pixel)});
  }
  return table;
}

Table design_rival_rows(const DesignResult& result) {
  Table table({"rival", "off by > 3 % in %", "> 10 % in %", "P_d in %", "P_fa in %", "memory mm2", "bits",
               "frames of a result", "logic, clock, power"});
  for (const RivalOption& rival : result.rivals) {
    const LightScore& worst = rival.score.worst();
    table.add({std::string(rival.entry->title), share_text(worst.above_3_percent),
               optional_share(worst.above_10_percent, 2), optional_share(worst.detected, 1),
               optional_share(worst.false_alarms, 2), fmt::format("{:.2f}", rival.memory_mm2),
               fmt::format("{}", rival.bits_per_pixel), fmt::format("{}", rival.frames), kNotEstimated});
  }
  return table;
}

std::string design_rivals(const DesignResult& result) {
  if (result.rivals.empty() && result.rivals_left_out.empty()) {
    return "";
  }
  std::string text;
  if (!result.rivals.empty()) {
    text = fmt::format("{}\nLogic, clock and power of rivals are not estimated: {}.\n",
                       design_rival_rows(result).markdown(), kRivalsWithoutRtl);
  }
  if (!result.rivals_left_out.empty()) {
    text += fmt::format("{} rivals are left out.\n", result.rivals_left_out.size());
  }
  return text;
}

std::string design_more_accurate(const DesignResult& result) {
  constexpr std::size_t kMostNamed = 3;
  if (result.rivals.empty()) {
    return "";
  }
  const std::vector<const RivalOption*> better = more_accurate_rivals(result);
  if (better.empty()) {
    return fmt::format("No rival of {} is more accurate.\n", result.rivals.size());
  }
  std::vector<std::string> names;
  for (const RivalOption* rival : better) {
    if (names.size() < kMostNamed) {
      names.push_back(fmt::format("{}, {} %, {} bits a pixel, {:.2f} mm2 of memory alone{}",
                                  rival->entry->title, share_text(rival->score.worst().above_3_percent),
                                  rival->bits_per_pixel, rival->memory_mm2,
                                  rival->frames > 1 ? fmt::format(", {} frames", rival->frames) : ""));
    }
  }
  return fmt::format(
      "More accurate, no RTL: {}{}.\n", fmt::join(names, "; "),
      better.size() > kMostNamed ? fmt::format("; and {} more", better.size() - kMostNamed) : "");
}

std::string design_recommendation(const DesignRequest& request, const DesignResult& result) {
  const Recommendation& found = result.recommendation;
  const DesignOption& chosen = result.options[*found.chosen];
  const LightScore& worst = chosen.best_known().worst();
  std::string text = fmt::format(
      "Recommended: {}, {}. {} % of the pixels are off by more than 3 % at {:g} klux, its worst light",  //
      name_of_choice(request, chosen), cost_text(request, chosen), share_text(worst.above_3_percent),
      worst.klux);
  const DesignOption& first = result.options[found.within.front()];
  if (found.within.size() == 1) {
    text += ". No other read-out keeps the limits.";
  } else if (found.within.front() == *found.chosen) {
    text += fmt::format(", the fewest of the {} read-outs that keep the limits.", found.within.size());
  } else {
    const Estimate& fewest = first.best_known().worst().above_3_percent;
    const std::string within =
        worst.above_3_percent.value <= kGoodRatio * fewest.value
            ? fmt::format("at most {:.2f} times", kGoodRatio)
            : fmt::format("at most {:g} % of the pixels more than", 100.0 * kGoodDifference);
    text +=
        fmt::format(", {} the {} % of {}, in a smaller array ({:.2f} of {:.2f} mm2).", within,
                    share_text(fewest), title_of(first), chosen.candidate.cost.mm2, first.candidate.cost.mm2);
  }
  const FrameBudget& budget = request.limits.budget;
  const double least_mhz =
      std::ceil(static_cast<double>(chosen.candidate.clocks) * budget.frames_per_s * kMegahertz);
  if (least_mhz < 0.9 * budget.clock_hz * kMegahertz) {
    text += fmt::format(" Its frames still fit at {:.0f} MHz, with {:.0f} mW.", least_mhz,
                        chosen.candidate.mw(least_mhz / kMegahertz));
  }
  if (found.competitor) {
    const DesignOption& other = result.options[*found.competitor];
    text += fmt::format(" Nearest competitor: {}, {}, {} %.", name_of_choice(request, other),
                        cost_text(request, other), share_text(other.best_known().worst().above_3_percent));
  }
  if (near_a_limit(request, chosen)) {
    text += " The estimate's error could take the array beyond a limit: --confirm measures it.";
  }
  return text + "\n";
}

std::string design_consequences(const DesignRequest& request, const DesignResult& result) {
  std::string text;
  const DesignOption& base = result.options[*result.recommendation.chosen];
  for (const DesignResult::Consequence& one : result.consequences) {
    text += fmt::format("* {}: ", one.change.name);
    if (!one.recommendation.chosen) {
      text += one.needed + "\n";
    } else if (*one.recommendation.chosen == *result.recommendation.chosen) {
      text += "the same\n";
    } else {
      const DesignOption& other = result.options[*one.recommendation.chosen];
      DesignRequest changed = request;
      changed.limits = one.change.limits;
      text += fmt::format("{}, {}, {} % instead of {} %\n", name_of_choice(request, other),
                          cost_text(changed, other), share_text(other.best_known().worst().above_3_percent),
                          share_text(base.best_known().worst().above_3_percent));
    }
  }
  return text;
}

std::vector<std::string> design_clocks(const DesignRequest& request, const DesignResult& result) {
  const SensorModel& sensor = request.bench.sensor;
  std::vector<std::string> sentences;
  for (const std::size_t i : result.recommendation.within) {
    const ArrayChoice& array = result.options[i].candidate.array;
    sentences.push_back(
        frame_fit(array.parameters, array.rows, array.columns, sensor.acquisitions, request.limits.budget)
            .sentence);
  }
  return sentences;
}

std::string design_page(const DesignRequest& request, const DesignResult& result,
                        const std::string& sensor_name, const std::string& command_line,
                        const std::string& confirmed) {
  const SensorModel& sensor = request.bench.sensor;
  std::vector<std::string_view> scenes;
  for (const Scene scene : request.bench.scenes) {
    scenes.push_back(scene_name(scene));
  }
  const DesignOption& chosen = result.options[*result.recommendation.chosen];
  std::string text = fmt::format(
      "# A read-out for {}\n\n{} x {} pixels, {} bits, {} acquisitions, {} SLOTS; {}.\n\n{}\n![Pixels off "
      "against "
      "area](design.svg)\n\n{}\n{}\n",
      sensor.name, sensor.columns, sensor.rows, sensor.np, sensor.acquisitions, sensor.slots,
      limits_text(request.limits), design_recommendation(request, result) + design_more_accurate(result),
      design_rows(request, result).markdown(), errors_text());
  text += fmt::format(
      "\nPixels that are off: in the light with most of them, intervals at 95 %. P_d: pixels that pass one "
      "threshold of "
      "confidence and are at most 10 % off; P_fa: pixels of other skies that pass; the threshold lets at "
      "most {:g} of "
      "the sky's pixels pass. mW: while acquisitions stream in, in the brightest light. fmax: slow corner. "
      "Latency: from a frame's last timestamps "
      "to its last result.\n",
      request.bench.false_alarms);
  if (const std::string rivals = design_rivals(result); !rivals.empty()) {
    text += "\n## Rivals\n\n" + rivals;
  }
  text += "\n## What 10 % more or less would bring\n\n" + design_consequences(request, result);
  text += "\n## Clocks of a frame\n\n";
  for (const std::string& sentence : design_clocks(request, result)) {
    text += "* " + sentence + "\n";
  }
  if (!result.left_out.empty() || !result.rivals_left_out.empty()) {
    text += "\n## Left out\n\n";
    for (const LeftOut& one : result.left_out) {
      text += fmt::format("* {}: {}\n", readout_title(one.readout), one.reason);
    }
    for (const RivalLeftOut& one : result.rivals_left_out) {
      text += fmt::format("* {} (rival): {}\n", one.entry->title, one.reason);
    }
  }
  if (!confirmed.empty()) {
    text += "\n## Confirmed\n\n" + confirmed;
  }
  text += fmt::format(
      "\n## The product\n\n    {}\n\n## How it was found\n\n{} sets of "
      "parameters "
      "were estimated; {} that keep the limits, or a limit that is 10 % looser, were read in one frame of "
      "each scene and "
      "light; the best of each read-out, and the smallest that is as good, in {} frames of {} pixels{}. "
      "Scenes: {}, distances in proportion to "
      "the sensor's "
      "range; lights: {} klux; models, exact photons, look-up tables from flat targets, seed {}. The "
      "smallest array is taken whose share is at most {:.2f} times the smallest share, or at most {:g} % of "
      "the "
      "pixels larger.\n\nCommand: `{}`\n",
      design_product(request, result, sensor_name), result.searched, result.options.size(), result.frames,
      chosen.best_known().pixels, contest_text(result), fmt::join(scenes, ", "),
      fmt::join(request.bench.klux, ", "), request.bench.seed, kGoodRatio, 100.0 * kGoodDifference,
      command_line);
  return text;
}

std::string design_csv(const DesignRequest& request, const DesignResult& result) {
  Table table({"readout", "parameters", "klux", "above_3_percent", "low", "high", "above_10_percent",
               "rmse_m", "detected", "false_alarms", "mm2", "mw", "fmax_mhz", "clocks", "bits_per_pixel",
               "frames", "memory_mm2", "latency_clocks"});
  const auto errors_of = [](const std::string& name, const std::string& parameters, const LightScore& light) {
    const auto share = [](const std::optional<Estimate>& one) {
      return one ? fmt::format("{:.6f}", one->value) : "";
    };
    const Estimate& above = light.above_3_percent;
    return std::vector<std::string>{name,
                                    parameters,
                                    fmt::format("{:g}", light.klux),
                                    fmt::format("{:.6f}", above.value),
                                    fmt::format("{:.6f}", above.covering().low),
                                    fmt::format("{:.6f}", above.covering().high),
                                    fmt::format("{:.6f}", light.above_10_percent.value),
                                    fmt::format("{:.4f}", light.rmse_m),
                                    share(light.detected),
                                    share(light.false_alarms)};
  };
  const auto add = [&](std::vector<std::string> cells, const std::vector<std::string>& others) {
    cells.insert(cells.end(), others.begin(), others.end());
    table.add(std::move(cells));
  };
  for (const DesignOption& option : result.options) {
    const DesignCandidate& candidate = option.candidate;
    for (const LightScore& light : option.best_known().lights) {
      add(errors_of(std::string(readout_name(candidate.readout())), candidate.array.parameters.to_string(),
                    light),
          {fmt::format("{:.4f}", candidate.cost.mm2),
           fmt::format("{:.2f}", candidate.mw(request.limits.budget.clock_hz)),
           fmt::format("{:.1f}", candidate.cost.fmax_mhz), fmt::format("{}", candidate.clocks),
           fmt::format("{:g}", candidate.cost.bits_per_pixel),
           fmt::format("{}", light.above_3_of_frames.size()), "",
           fmt::format("{}", latency_clocks(candidate))});
    }
  }
  for (const RivalOption& rival : result.rivals) {
    for (const LightScore& light : rival.score.lights) {
      add(errors_of(std::string(rival.entry->name), "rival", light),
          {kNotEstimated, kNotEstimated, kNotEstimated, kNotEstimated,
           fmt::format("{}", rival.bits_per_pixel), fmt::format("{}", result.frames),
           fmt::format("{:.4f}", rival.memory_mm2), kNotEstimated});
    }
  }
  return table.csv();
}

}  // namespace dtof
