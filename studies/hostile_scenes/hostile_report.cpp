// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/hostile_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "common/engine_frame.hpp"
#include "common/percent_text.hpp"
#include "dtof/sensor/condition.hpp"

namespace dtof {
namespace {

constexpr double kFooled = 0.1;

/// "late-laser (14, 50 klux)" of each condition with a light.
std::vector<std::string> named(const HostileSettings& settings,
                               const std::map<std::string, std::vector<std::string>>& lights) {
  std::vector<std::string> texts;
  for (const std::string& condition : settings.conditions) {
    const auto found = lights.find(condition);
    if (found != lights.end()) {
      texts.push_back(fmt::format("{} ({} klux)", condition, fmt::join(found->second, ", ")));
    }
  }
  return texts;
}

std::string list_or(const std::vector<std::string>& texts, const char* none) {
  return texts.empty() ? none : fmt::format("{}", fmt::join(texts, ", "));
}

std::vector<std::string> header(const HostileSettings& settings) {
  std::vector<std::string> texts = {"condition"};
  for (const std::string& name : hostile_estimators(settings)) {
    texts.push_back(hostile_title(name));
  }
  return texts;
}

std::string error_table(const HostileSettings& settings, const HostileScenes& study, double klux) {
  Table table(header(settings));
  for (const std::string& condition : settings.conditions) {
    const HostileReadouts& readouts = study.cells.at({condition, klux});
    std::vector<std::string> row = {condition};
    for (const std::string& name : hostile_estimators(settings)) {
      row.push_back(fmt::format("{} / {}", percent_text(share_above(readouts.at(name), 3).value),
                                percent_text(share_above(readouts.at(name), 10).value)));
    }
    table.add(std::move(row));
  }
  return table.markdown();
}

std::string compensated_table(const HostileSettings& settings, const HostileScenes& study, double klux) {
  std::vector<std::string> texts = {"condition"};
  for (const std::string& name : compensated_estimators(settings)) {
    texts.push_back(hostile_title(name));
  }
  Table table(texts);
  for (const std::string& condition : compensated_conditions(settings)) {
    const HostileReadouts& readouts = study.compensated.at({condition, klux});
    std::vector<std::string> row = {condition};
    for (const std::string& name : compensated_estimators(settings)) {
      row.push_back(fmt::format("{} / {}", percent_text(share_above(readouts.at(name), 3).value),
                                percent_text(share_above(readouts.at(name), 10).value)));
    }
    table.add(std::move(row));
  }
  return table.markdown();
}

std::string compensated_section(const HostileSettings& settings, const HostileScenes& study) {
  if (compensated_conditions(settings).empty()) {
    return "";
  }
  std::string text =
      "\n## With settings for the sensor and its surroundings\n\n"
      "Settings of a user who knows the sensor and its surroundings. *Cover glass and fog*: the TEMPLATE "
      "registers of the pool read-outs come from a frame in the dark without a target "
      "(docs/reference/poolpointer.md, Template). The matched filters count the mean events of that frame as "
      "background. The matched filters are no bound here: they expect the signal of a target at 3 m, and "
      "rate a fainter target as less likely than strong crosstalk. The coarse histogram has no setting "
      "except a gate. *Skew*: S1 of the pool read-outs is off (OUTPUT.SMOOTH), because S1 draws neighbours "
      "together although their skews differ. *A laser that is silent at first*: SETTLE drops the silent "
      "acquisitions at the frame's start, and ACQUISITIONS is smaller by the same number, so that a frame "
      "takes no longer; this holds for all read-outs. *Motion*: each read-out is judged at its own instant "
      "(below). Pixels with a target above 3 % / above 10 %, in %:\n";
  for (const double klux : settings.klux) {
    text += fmt::format("\n{:g} klux:\n\n{}", klux, compensated_table(settings, study, klux));
  }
  return text;
}

std::string instant_text(const std::optional<double>& instant) {
  return instant ? fmt::format("{:.2f}", *instant) : "-";
}

std::string motion_table(const HostileSettings& settings, const HostileScenes& study,
                         const HostileCell& cell) {
  const OwnInstants& own = study.instants.at(cell);
  std::vector<std::string> header = {"read-out", "middle of its part"};
  for (const double distance : own.distances_m) {
    header.push_back(fmt::format("at {:g} m", distance));
  }
  header.insert(header.end(), {"bias, mm", "above 3 / 10 %", "bias, mm, own", "above 3 / 10 %, own"});
  Table table(header);
  const std::vector<std::string> names = hostile_estimators(settings);
  for (std::size_t e = 0; e < names.size(); ++e) {
    const std::optional<double> middle =
        e < settings.readouts.size() ? middle_of_position(settings.readouts[e]) : kMiddleOfAFrame;
    std::vector<std::string> row = {hostile_title(names[e]), instant_text(middle)};
    for (const std::optional<double>& instant : own.instants.at(names[e])) {
      row.push_back(instant_text(instant));
    }
    for (const HostileReadouts* readouts : {&study.cells.at(cell), &study.compensated.at(cell)}) {
      const std::vector<HostileCounts>& seeds = readouts->at(names[e]);
      row.push_back(fmt::format("{:.0f}", 1e3 * mean_error(seeds)));
      row.push_back(fmt::format("{} / {}", percent_text(share_above(seeds, 3).value),
                                percent_text(share_above(seeds, 10).value)));
    }
    table.add(std::move(row));
  }
  return table.markdown();
}

std::string motion_section(const HostileSettings& settings, const HostileScenes& study) {
  if (study.instants.empty()) {
    return "";
  }
  std::string text =
      "\n## Motion, judged at each read-out's own instant\n\n"
      "A depth belongs to an instant of the frame, 0 at its start and 1 at its end "
      "(docs/reference/readouts.md, Instant of a depth). Measured with walls of other seeds that go away and "
      "come nearer; \"-\": most of the wall's pixels are further off than 0.3 m. *Middle of its part*: of "
      "the part of the frame that makes the position, beside it. Bias, the mean error of pixels at most 0.3 "
      "m "
      "off, and errors in %: against where targets are at the frame's middle, and at the own instant, which "
      "is between the walls' distances in proportion.\n";
  for (const auto& [cell, instants] : study.instants) {
    text +=
        fmt::format("\n{}, {:g} klux:\n\n{}", cell.condition, cell.klux, motion_table(settings, study, cell));
  }
  return text;
}

std::string alarm_table(const HostileSettings& settings, const HostileScenes& study, double klux) {
  Table table(header(settings));
  std::vector<std::string> thresholds = {"threshold"};
  for (const std::string& name : hostile_estimators(settings)) {
    thresholds.push_back(fmt::format("{}", study.thresholds.at(name)));
  }
  table.add(std::move(thresholds));
  for (const std::string& condition : settings.conditions) {
    const HostileReadouts& readouts = study.cells.at({condition, klux});
    std::vector<std::string> row = {condition};
    for (const std::string& name : hostile_estimators(settings)) {
      const std::vector<HostileCounts>& seeds = readouts.at(name);
      const int threshold = study.thresholds.at(name);
      const std::optional<Estimate> alarms = share_of_false_alarms(seeds, threshold);
      row.push_back(fmt::format("{} / {}", alarms ? percent_text(alarms->value) : "-",
                                percent_text(share_detected(seeds, threshold).value)));
    }
    table.add(std::move(row));
  }
  return table.markdown();
}

/// "glass 0.15 / 3.1" of each compensated condition, above 3 %, over the lights.
std::string compensated_sentence(const HostileSettings& settings, const HostileScenes& study,
                                 const std::string& name) {
  std::vector<std::string> texts;
  for (const std::string& condition : compensated_conditions(settings)) {
    std::vector<std::string> shares;
    for (const double klux : settings.klux) {
      shares.push_back(percent_text(share_above(study.compensated.at({condition, klux}).at(name), 3).value));
    }
    texts.push_back(fmt::format("{} {}", condition, fmt::join(shares, " / ")));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// "poolPointer 99 / 80" of each estimator.
std::string detected_sentence(const HostileSettings& settings, const HostileScenes& study) {
  std::vector<std::string> texts;
  for (const std::string& name : hostile_estimators(settings)) {
    std::vector<std::string> shares;
    for (const double klux : settings.klux) {
      shares.push_back(percent_text(
          share_detected(study.cells.at({std::string(kClear), klux}).at(name), study.thresholds.at(name))
              .value));
    }
    texts.push_back(fmt::format("{} {}", hostile_title(name), fmt::join(shares, " / ")));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string conditions_section(const HostileSettings& settings) {
  std::string text;
  for (const std::string& name : settings.conditions) {
    const auto found = std::ranges::find(conditions(), name, &Condition::name);
    if (found != conditions().end()) {
      text += fmt::format("* {}: {}.\n", name, found->says);
    }
  }
  return text;
}

std::string scene_names(const HostileSettings& settings) {
  std::vector<std::string_view> names;
  for (const Scene scene : settings.scenes) {
    names.push_back(scene_name(scene));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::vector<std::string> behind_coarse_histogram(const HostileSettings& settings, const HostileScenes& study,
                                                 const std::string& estimator, bool compensated) {
  std::map<std::string, std::vector<std::string>> lights;
  for (const auto& [cell, uncompensated] : study.cells) {
    const auto found = study.compensated.find(cell);
    const HostileReadouts& readouts =
        compensated && found != study.compensated.end() ? found->second : uncompensated;
    const auto coarse = readouts.find(std::string(readout_name(Readout::kCoarseHistogram)));
    if (coarse == readouts.end()) {
      return {};
    }
    if (share_above(readouts.at(estimator), 3).interval.low >
        2.0 * share_above(coarse->second, 3).interval.high) {
      lights[cell.condition].push_back(fmt::format("{:g}", cell.klux));
    }
  }
  return named(settings, lights);
}

std::vector<std::string> fooled_together(const HostileSettings& settings, const HostileScenes& study) {
  std::map<std::string, std::vector<std::string>> lights;
  for (const auto& [cell, readouts] : study.cells) {
    double best = std::numeric_limits<double>::infinity();
    for (const ReadoutParameters& readout : settings.readouts) {
      best = std::min(best, share_above(readouts.at(std::string(readout_name(readout.readout))), 10).value);
    }
    if (best > kFooled) {
      lights[cell.condition].push_back(fmt::format("{} % at {:g}", percent_text(best), cell.klux));
    }
  }
  return named(settings, lights);
}

std::string hostile_report(const HostileSettings& settings, const HostileScenes& study,
                           const std::string& command_line) {
  std::string report = fmt::format(
      "# What each read-out survives\n\n"
      "{} read-outs and two matched filters under {} conditions, sensor `{}`, {:g} klux.\n\n"
      "* Every read-out has more than 10 % of its pixels off by more than 10 %, the best one's share named, "
      "under: "
      "{}.\n",
      settings.readouts.size(), settings.conditions.size(), settings.sensor.name,
      fmt::join(settings.klux, " and "), list_or(fooled_together(settings, study), "no condition"));
  for (const ReadoutParameters& readout : settings.readouts) {
    if (is_pool_readout(readout.readout)) {
      const std::string name(readout_name(readout.readout));
      report += fmt::format(
          "* {} has more than twice the coarse histogram's errors above 3 %, beyond both intervals, "
          "under: {}.\n",
          hostile_title(name),
          list_or(behind_coarse_histogram(settings, study, name, false), "no condition"));
      if (!compensated_conditions(settings).empty()) {
        report += fmt::format(
            "* With these settings for both, {} has more than twice the coarse histogram's errors under: {}. "
            "Its pixels above 3 %, in % at {:g} klux: {}.\n",
            hostile_title(name),
            list_or(behind_coarse_histogram(settings, study, name, true), "no condition"),
            fmt::join(settings.klux, " / "), compensated_sentence(settings, study, name));
      }
    }
  }
  report += fmt::format(
      "* A threshold that at most {:g} % of a clear sky's pixels pass at each light leads to these shares "
      "of the pixels with a target, in clear conditions, that pass it and are within 3 %, in % at {:g} klux: "
      "{}.\n\n",
      100.0 * settings.false_alarms, fmt::join(settings.klux, " / "), detected_sentence(settings, study));
  report += "![Detection over false alarms](hostile_scenes.svg)\n";
  for (const double klux : settings.klux) {
    report +=
        fmt::format("\n## Errors at {:g} klux\n\nPixels with a target above 3 % / above 10 %, in %:\n\n{}",
                    klux, error_table(settings, study, klux));
  }
  report += compensated_section(settings, study) + motion_section(settings, study);
  for (const double klux : settings.klux) {
    report += fmt::format(
        "\n## False alarms and detection at {:g} klux\n\n"
        "P_fa, share of the pixels without a target whose confidence reaches the threshold, / P_d, share of "
        "the "
        "pixels with a target whose confidence reaches it and whose error is at most 3 %, in %:\n\n{}",
        klux, alarm_table(settings, study, klux));
  }
  const HostileCounts& counts = study.cells.begin()->second.begin()->second.front();
  report += fmt::format(
      "\n## Conditions\n\n{}\n"
      "## How it was measured\n\n"
      "Models, exact photons. Scenes {}: {} rows of the {} columns (an engine of poolPointer) around the "
      "centre of "
      "the sensor's pixels. {} seeds from {} on, each with {} pixels with a target and {} without. Each "
      "estimator has "
      "one look-up table for each light, of the sensor in clear conditions, and subtracts the known skew; "
      "nothing "
      "else is known to it, but where a table says so. No host filter.\n\n"
      "The threshold of an estimator is the lowest confidence that at most {:g} % of the pixels of frames of "
      "sky "
      "alone reach, in clear conditions, at each light; other seeds than those of the tables. The sky is as "
      "bright as "
      "a surface of the sensor's reflectivity. It is one number for all lights and conditions.\n\n"
      "The matched filters keep full histograms and know the pulse, each pixel's background and the signal "
      "of a target "
      "at 3 m; the pooled one pools along the column (readout/pooled_matched_filter.hpp). Their confidence "
      "is eight "
      "times their score.\n\n"
      "Intervals (95 %) come from the spread of the seeds, and are at least Wilson's for independent pixels. "
      "Every "
      "figure with its interval: [data/hostile_scenes.csv.gz](data/hostile_scenes.csv.gz).\n\n"
      "Command: `{}`\n",
      conditions_section(settings), scene_names(settings), settings.rows, engine_columns_judged(),
      settings.seeds, settings.seed, counts.targets(), counts.count(Outcome::kSky),
      100.0 * settings.false_alarms, command_line);
  return report;
}

Table hostile_csv(const HostileSettings& settings, const HostileScenes& study) {
  Table table({"readout", "condition", "klux", "pixels", "above_3_percent", "above_3_low", "above_3_high",
               "above_10_percent", "above_10_low", "above_10_high", "threshold", "detected", "detected_low",
               "detected_high", "sky_pixels", "false_alarms", "false_alarms_low", "false_alarms_high"},
              2);
  const auto add_row = [&](const std::string& name, const std::string& condition, double klux,
                           const std::vector<HostileCounts>& seeds) {
    const int threshold = study.thresholds.at(name);
    std::uint64_t pixels = 0;
    std::uint64_t sky = 0;
    for (const HostileCounts& counts : seeds) {
      pixels += counts.targets();
      sky += counts.count(Outcome::kSky);
    }
    std::vector<std::string> row = {name, condition, fmt::format("{:g}", klux), fmt::format("{}", pixels)};
    const auto add = [&row](const Estimate& share) {
      for (const double value : {share.value, share.interval.low, share.interval.high}) {
        row.push_back(fmt::format("{:.6g}", value));
      }
    };
    add(share_above(seeds, 3));
    add(share_above(seeds, 10));
    row.push_back(fmt::format("{}", threshold));
    add(share_detected(seeds, threshold));
    row.push_back(fmt::format("{}", sky));
    if (const std::optional<Estimate> alarms = share_of_false_alarms(seeds, threshold)) {
      add(*alarms);
    } else {
      row.insert(row.end(), 3, "");
    }
    table.add(std::move(row));
  };
  for (const double klux : settings.klux) {
    for (const std::string& condition : settings.conditions) {
      for (const std::string& name : hostile_estimators(settings)) {
        add_row(name, condition, klux, study.cells.at({condition, klux}).at(name));
      }
    }
    for (const std::string& condition : compensated_conditions(settings)) {
      for (const std::string& name : compensated_estimators(settings)) {
        add_row(name, "told-" + condition, klux, study.compensated.at({condition, klux}).at(name));
      }
    }
  }
  return table;
}

std::vector<PlotSeries> hostile_curves(const HostileSettings& settings, const HostileScenes& study) {
  std::vector<PlotSeries> curves;
  const double klux = std::ranges::max(settings.klux);
  for (const std::string& name : hostile_estimators(settings)) {
    const std::vector<HostileCounts>& seeds = study.cells.at({std::string(kClear), klux}).at(name);
    std::set<int> thresholds;
    for (const HostileCounts& counts : seeds) {
      for (const auto& [confidence, pixels] :
           counts.by_confidence.at(static_cast<std::size_t>(Outcome::kSky))) {
        thresholds.insert(confidence);
      }
    }
    if (thresholds.size() < 2) {
      continue;
    }
    PlotSeries curve{hostile_title(name), {}, {}};
    constexpr std::size_t kMostPoints = 100;
    const std::size_t step = 1 + thresholds.size() / kMostPoints;
    std::size_t number = 0;
    for (const int threshold : thresholds) {
      if (number++ % step == 0) {
        curve.x.push_back(100.0 * share_of_false_alarms(seeds, threshold)->value);
        curve.y.push_back(100.0 * share_detected(seeds, threshold).value);
      }
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace dtof
