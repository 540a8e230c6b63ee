// SPDX-License-Identifier: Apache-2.0
#include "design/design_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "dtof/core/frame_time.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"

namespace dtof {
namespace {

constexpr double kPerCent = 100.0;
constexpr double kMegahertz = 1e-6;

std::string title_of(const DesignOption& option) {
  return std::string(readout_title(option.candidate.readout()));
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
  const std::string options = command_options(option.candidate.array.parameters, request.bench.sensor);
  const std::size_t end = options.find(' ', std::string("--readout ").size());
  const ArrayChoice& array = option.candidate.array;
  return title_of(option) + (end == std::string::npos ? "" : options.substr(end)) +
         (array.arrays > 1 ? fmt::format(", {} arrays of {} columns", array.arrays, array.columns) : "");
}

/// What the sensor of a product has to be where it is not the whole one.
std::string product_note(const DesignOption& option) {
  const ArrayChoice& array = option.candidate.array;
  return array.arrays > 1
             ? fmt::format("  # with columns = {} in the sensor file, {} times", array.columns, array.arrays)
             : "";
}

}  // namespace

std::string design_product(const DesignRequest& request, const DesignResult& result,
                           const std::string& sensor_name) {
  const DesignOption& chosen = result.options[*result.recommendation.chosen];
  return fmt::format("dtof product --sensor {} {} --out chip{}", sensor_name,
                     command_options(chosen.candidate.array.parameters, request.bench.sensor),
                     product_note(chosen));
}

std::string design_table(const DesignRequest& request, const DesignResult& result) {
  const double clock_hz = request.limits.budget.clock_hz;
  Table table({"read-out", "off by > 3 % in %", "> 10 % in %", "P_d in %", "P_fa in %", "mm2", "mW",
               "fmax MHz", "frames/s", "bits"});
  for (const std::size_t i : result.recommendation.within) {
    const DesignOption& option = result.options[i];
    const LightScore& worst = option.best_known().worst();
    table.add({name_of_choice(request, option), share_text(worst.above_3_percent),
               optional_share(worst.above_10_percent, 2), optional_share(worst.detected, 1),
               optional_share(worst.false_alarms, 2), fmt::format("{:.2f}", option.candidate.cost.mm2),
               fmt::format("{:.0f}", option.candidate.mw(clock_hz)),
               fmt::format("{:.0f}", option.candidate.cost.fmax_mhz),
               fmt::format("{:.1f}", option.candidate.frames_per_s(clock_hz)),
               fmt::format("{:g}", option.candidate.cost.bits_per_pixel)});
  }
  return table.markdown();
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
    text += fmt::format(
        ", which the intervals do not tell from {}'s {} %, in a smaller array ({:.2f} of {:.2f} mm2).",
        title_of(first), share_text(first.best_known().worst().above_3_percent), chosen.candidate.cost.mm2,
        first.candidate.cost.mm2);
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
      limits_text(request.limits), design_recommendation(request, result), design_table(request, result),
      errors_text());
  text += fmt::format(
      "\nPixels that are off: in the light with most of them, intervals at 95 %. P_d: pixels that pass one "
      "threshold of "
      "confidence and are at most 10 % off; P_fa: pixels of other skies that pass; the threshold lets at "
      "most {:g} of "
      "the sky's pixels pass. mW: while acquisitions stream in, in the brightest light. fmax: slow corner.\n",
      request.bench.false_alarms);
  text += "\n## What 10 % more or less would bring\n\n" + design_consequences(request, result);
  text += "\n## Clocks of a frame\n\n";
  for (const std::size_t i : result.recommendation.within) {
    const ReadoutParameters& parameters = result.options[i].candidate.array.parameters;
    text += "* " +
            frame_fit(parameters, sensor.rows, sensor.columns, sensor.acquisitions, request.limits.budget)
                .sentence +
            "\n";
  }
  if (!result.left_out.empty()) {
    text += "\n## Left out\n\n";
    for (const LeftOut& one : result.left_out) {
      text += fmt::format("* {}: {}\n", readout_title(one.readout), one.reason);
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
      "light; the best of each read-out in {} frames of {} pixels. Scenes: {}, distances in proportion to "
      "the sensor's "
      "range; lights: {} klux; models, exact photons, look-up tables from flat targets, seed {}. Equally "
      "good arrays: "
      "the smaller one is taken.\n\nCommand: `{}`\n",
      design_product(request, result, sensor_name), result.searched, result.options.size(), result.frames,
      chosen.best_known().pixels, fmt::join(scenes, ", "), fmt::join(request.bench.klux, ", "),
      request.bench.seed, command_line);
  return text;
}

void write_design_picture(const std::filesystem::path& path, const DesignRequest& request,
                          const DesignResult& result) {
  std::map<Readout, std::vector<std::pair<double, double>>> points;
  double least = 1.0;
  double most = 0.0;
  for (const DesignOption& option : result.options) {
    constexpr double kLeastShown = 1e-4;  // of pixels: a logarithmic axis has no 0
    const double share = std::max(option.best_known().worst().above_3_percent.value, kLeastShown);
    points[option.candidate.readout()].emplace_back(option.candidate.cost.mm2, kPerCent * share);
    least = std::min(least, share);
    most = std::max(most, share);
  }
  std::vector<PlotSeries> series;
  for (auto& [readout, of] : points) {
    std::ranges::sort(of);
    PlotSeries one{.label = std::string(readout_title(readout)), .x = {}, .y = {}};
    for (const auto& [mm2, share] : of) {
      one.x.push_back(mm2);
      one.y.push_back(share);
    }
    series.push_back(std::move(one));
  }
  if (std::isfinite(request.limits.most_mm2)) {
    series.push_back({.label = "limit of area",
                      .x = {request.limits.most_mm2, request.limits.most_mm2},
                      .y = {kPerCent * least, kPerCent * most}});
  }
  write_plot(
      path, series,
      {.title = fmt::format("{}: pixels off by more than 3 %, against area", request.bench.sensor.name),
       .x_label = "area of the array in mm2",
       .y_label = "pixels off by more than 3 %, in %",
       .logarithmic_y = true,
       .y_limits = {},
       .logarithmic_x = true});
}

std::string design_csv(const DesignRequest& request, const DesignResult& result) {
  Table table({"readout", "parameters", "klux", "above_3_percent", "low", "high", "above_10_percent",
               "rmse_m", "detected", "false_alarms", "mm2", "mw", "fmax_mhz", "clocks", "bits_per_pixel",
               "frames"});
  for (const DesignOption& option : result.options) {
    for (const LightScore& light : option.best_known().lights) {
      const Estimate& above = light.above_3_percent;
      const auto share = [](const std::optional<Estimate>& one) {
        return one ? fmt::format("{:.6f}", one->value) : "";
      };
      table.add(
          {std::string(readout_name(option.candidate.readout())),
           option.candidate.array.parameters.to_string(), fmt::format("{:g}", light.klux),
           fmt::format("{:.6f}", above.value), fmt::format("{:.6f}", above.covering().low),
           fmt::format("{:.6f}", above.covering().high), fmt::format("{:.6f}", light.above_10_percent.value),
           fmt::format("{:.4f}", light.rmse_m), share(light.detected), share(light.false_alarms),
           fmt::format("{:.4f}", option.candidate.cost.mm2),
           fmt::format("{:.2f}", option.candidate.mw(request.limits.budget.clock_hz)),
           fmt::format("{:.1f}", option.candidate.cost.fmax_mhz), fmt::format("{}", option.candidate.clocks),
           fmt::format("{:g}", option.candidate.cost.bits_per_pixel),
           fmt::format("{}", option.score ? result.frames : 1)});
    }
  }
  return table.csv();
}

}  // namespace dtof
