// SPDX-License-Identifier: Apache-2.0
#include "hostile_scenes/hostile_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

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

/// The conditions by name; nothing if there is none.
std::optional<PageData> where(const std::vector<std::string>& named_conditions) {
  if (named_conditions.empty()) {
    return std::nullopt;
  }
  return PageData().set("where", "{}", fmt::join(named_conditions, ", "));
}

std::vector<std::string> header(const HostileSettings& settings) {
  std::vector<std::string> texts = {"condition"};
  for (const std::string& name : hostile_estimators(settings)) {
    texts.push_back(hostile_title(name));
  }
  return texts;
}

Table error_table(const HostileSettings& settings, const HostileScenes& study, double klux) {
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
  return table;
}

Table compensated_table(const HostileSettings& settings, const HostileScenes& study, double klux) {
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
  return table;
}

std::optional<PageData> compensated_data(const HostileSettings& settings, const HostileScenes& study) {
  if (compensated_conditions(settings).empty()) {
    return std::nullopt;
  }
  std::vector<PageData> lights;
  for (const double klux : settings.klux) {
    lights.push_back(
        PageData().set("klux", "{:g}", klux).set("errors", compensated_table(settings, study, klux)));
  }
  return PageData().list("at_lights", std::move(lights));
}

std::string instant_text(const std::optional<double>& instant) {
  return instant ? fmt::format("{:.2f}", *instant) : "-";
}

Table motion_table(const HostileSettings& settings, const HostileScenes& study, const HostileCell& cell) {
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
  return table;
}

std::optional<PageData> motion_data(const HostileSettings& settings, const HostileScenes& study) {
  if (study.instants.empty()) {
    return std::nullopt;
  }
  std::vector<PageData> motions;
  for (const auto& [cell, instants] : study.instants) {
    motions.push_back(PageData()
                          .set("condition", "{}", cell.condition)
                          .set("klux", "{:g}", cell.klux)
                          .set("instants", motion_table(settings, study, cell)));
  }
  return PageData().list("motions", std::move(motions));
}

Table alarm_table(const HostileSettings& settings, const HostileScenes& study, double klux) {
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
  return table;
}

/// "glass 0.15 / 3.1" of each compensated condition, above 3 %, over the lights.
std::string compensated_shares(const HostileSettings& settings, const HostileScenes& study,
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
std::string detected_shares(const HostileSettings& settings, const HostileScenes& study) {
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

std::vector<PageData> condition_texts(const HostileSettings& settings) {
  std::vector<PageData> texts;
  for (const std::string& name : settings.conditions) {
    const auto found = std::ranges::find(conditions(), name, &Condition::name);
    if (found != conditions().end()) {
      texts.push_back(PageData().set("condition", "{}", name).set("says", "{}", found->says));
    }
  }
  return texts;
}

std::string scene_names(const HostileSettings& settings) {
  std::vector<std::string_view> names;
  for (const Scene scene : settings.scenes) {
    names.push_back(scene_name(scene));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<PageData> pool_readouts(const HostileSettings& settings, const HostileScenes& study) {
  std::vector<PageData> readouts;
  for (const ReadoutParameters& readout : settings.readouts) {
    if (!is_pool_readout(readout.readout)) {
      continue;
    }
    const std::string name(readout_name(readout.readout));
    std::optional<PageData> with_settings;
    if (!compensated_conditions(settings).empty()) {
      with_settings = PageData()
                          .part("still_behind", where(behind_coarse_histogram(settings, study, name, true)))
                          .set("shares", "{}", compensated_shares(settings, study, name));
    }
    readouts.push_back(PageData()
                           .set("readout", "{}", hostile_title(name))
                           .part("behind", where(behind_coarse_histogram(settings, study, name, false)))
                           .part("with_settings", std::move(with_settings)));
  }
  return readouts;
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

PageData hostile_page(const HostileSettings& settings, const HostileScenes& study,
                      const std::string& command_line) {
  std::vector<PageData> errors;
  std::vector<PageData> alarms;
  for (const double klux : settings.klux) {
    errors.push_back(PageData().set("klux", "{:g}", klux).set("errors", error_table(settings, study, klux)));
    alarms.push_back(
        PageData().set("klux", "{:g}", klux).set("alarms_and_detection", alarm_table(settings, study, klux)));
  }
  const HostileCounts& counts = study.cells.begin()->second.begin()->second.front();
  PageData data;
  data.set("readouts", "{}", settings.readouts.size())
      .set("conditions", "{}", settings.conditions.size())
      .set("sensor", "{}", settings.sensor.name)
      .set("lights", "{:g}", fmt::join(settings.klux, " and "))
      .set("each_klux", "{:g}", fmt::join(settings.klux, " / "))
      .part("fooling", where(fooled_together(settings, study)))
      .list("pool_readouts", pool_readouts(settings, study))
      .set("false_alarms", "{:g}", 100.0 * settings.false_alarms)
      .set("detected", "{}", detected_shares(settings, study))
      .list("errors_at_lights", std::move(errors))
      .part("settings_of_a_user", compensated_data(settings, study))
      .part("motion", motion_data(settings, study))
      .list("alarms_at_lights", std::move(alarms))
      .list("condition_texts", condition_texts(settings))
      .set("scenes", "{}", scene_names(settings))
      .set("rows", "{}", settings.rows)
      .set("columns", "{}", engine_columns_judged())
      .set("seeds", "{}", settings.seeds)
      .set("seed", "{}", settings.seed)
      .set("pixels_with_a_target", "{}", counts.targets())
      .set("pixels_without", "{}", counts.count(Outcome::kSky))
      .set("command", "{}", command_line);
  return data;
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
