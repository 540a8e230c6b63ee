// SPDX-License-Identifier: Apache-2.0
#include "walk_error/walk_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "dtof/frame/flat_calibration.hpp"

namespace dtof {
namespace {

/// Mean over the judged points, in per cent.
double above_3_percent(const WalkReadout& readout, WalkErrors WalkPoint::*errors) {
  double sum = 0.0;
  for (const WalkPoint& point : readout.points) {
    sum += point.judged ? (point.*errors).above_3_percent : 0.0;
  }
  return readout.judged() == 0 ? 0.0 : 100.0 * sum / static_cast<double>(readout.judged());
}

/// Whether the correction takes at least half of the walk away.
bool halves_walk(const WalkReadout& readout) {
  return readout.walk_after_m() <= 0.5 * readout.walk_before_m();
}

std::string plus_minus(const Estimate& bias) {
  return fmt::format("{:.1f} +- {:.1f}", bias.value * 1e3, 500.0 * (bias.interval.high - bias.interval.low));
}

/// Reflectivities down, distances across.
Table bias_table(const WalkReadout& readout, const WalkSettings& settings) {
  std::vector<std::string> header = {"reflectivity"};
  for (const double distance : settings.distances_m) {
    header.push_back(fmt::format("{:g} m", distance));
  }
  Table table(std::move(header));
  for (std::size_t i = 0; i < settings.reflectivities.size(); ++i) {
    std::vector<std::string> row = {fmt::format("{:g}", settings.reflectivities[i])};
    for (std::size_t d = 0; d < settings.distances_m.size(); ++d) {
      const WalkPoint& point = readout.points[i * settings.distances_m.size() + d];
      row.push_back(point.judged ? fmt::format("{} -> {}", plus_minus(point.before.bias_m),
                                               plus_minus(point.after.bias_m))
                                 : "-");
    }
    table.add(std::move(row));
  }
  return table;
}

/// "ezPointer (105 to 52 mm)" of each read-out, by what the correction does to its walk.
struct Verdicts {
  std::vector<std::string> halved;
  std::vector<std::string> reduced;
  std::vector<std::string> not_reduced;
  std::vector<std::string> not_judged;  // names only
};

Verdicts judge(const std::vector<WalkReadout>& readouts) {
  Verdicts verdicts;
  for (const WalkReadout& readout : readouts) {
    const double before = readout.walk_before_m();
    const double after = readout.walk_after_m();
    if (before == 0.0) {  // no distance with two reflectivities that could be judged
      verdicts.not_judged.push_back(readout.title);
      continue;
    }
    std::vector<std::string>& group = halves_walk(readout) ? verdicts.halved
                                      : after < before     ? verdicts.reduced
                                                           : verdicts.not_reduced;
    group.push_back(fmt::format("{} ({:.0f} to {:.0f} mm)", readout.title, before * 1e3, after * 1e3));
  }
  return verdicts;
}

std::optional<PageData> walks(const std::vector<std::string>& group) {
  if (group.empty()) {
    return std::nullopt;
  }
  return PageData().set("walks", "{}", fmt::join(group, ", "));
}

}  // namespace

Table walk_summary(const std::vector<WalkReadout>& readouts) {
  Table table({"read-out", "points judged", "walk before, mm", "after", "rms bias before, mm", "after",
               "better", "worse", "above 3 % before, %", "after", "classes", "at largest confidence, %"});
  for (const WalkReadout& readout : readouts) {
    table.add({readout.title, fmt::format("{} of {}", readout.judged(), readout.points.size()),
               fmt::format("{:.1f}", readout.walk_before_m() * 1e3),
               fmt::format("{:.1f}", readout.walk_after_m() * 1e3),
               fmt::format("{:.1f}", readout.rms_bias_before_m() * 1e3),
               fmt::format("{:.1f}", readout.rms_bias_after_m() * 1e3), fmt::format("{}", readout.better()),
               fmt::format("{}", readout.worse()),
               fmt::format("{:.1f}", above_3_percent(readout, &WalkPoint::before)),
               fmt::format("{:.1f}", above_3_percent(readout, &WalkPoint::after)),
               fmt::format("{}", readout.classes), fmt::format("{:.1f}", readout.at_top * 100.0)});
  }
  return table;
}

PageData walk_page(const WalkSettings& settings, const std::vector<WalkReadout>& readouts,
                   const std::string& command_line) {
  const Verdicts verdicts = judge(readouts);
  std::vector<PageData> sections;
  sections.reserve(readouts.size());
  for (const WalkReadout& readout : readouts) {
    sections.push_back(
        PageData().set("readout", "{}", readout.title).set("biases", bias_table(readout, settings)));
  }
  PageData data;
  data.set("slots", "{}", settings.sensor.slots)
      .set("pixels", "{}", settings.columns * FlatCalibration::kPixels)
      .set("klux", "{:g}", settings.klux)
      .set("sensor", "{}", settings.sensor.name)
      .set("acquisitions", "{}", settings.sensor.acquisitions)
      .set("seed", "{}", settings.seed)
      .set("calibration", "{}", FlatCalibration(settings.sensor).description())
      .set("summary", walk_summary(readouts))
      .part("halved", walks(verdicts.halved))
      .part("reduced", walks(verdicts.reduced))
      .part("not_reduced", walks(verdicts.not_reduced))
      .part("not_judged", walks(verdicts.not_judged))
      .list("readouts", std::move(sections))
      .set("command", "{}", command_line);
  return data;
}

Table walk_csv(const std::vector<WalkReadout>& readouts) {
  std::vector<std::string> header = {"readout", "reflectivity", "distance_m", "found", "judged"};
  for (const char* way : {"before", "after"}) {
    for (const char* figure :
         {"bias_m", "bias_low", "bias_high", "rmse_m", "above_3_percent", "above_10_percent"}) {
      header.push_back(fmt::format("{}_{}", way, figure));
    }
  }
  Table table(std::move(header));
  for (const WalkReadout& readout : readouts) {
    for (const WalkPoint& point : readout.points) {
      std::vector<std::string> row = {readout.name, fmt::format("{:g}", point.reflectivity),
                                      fmt::format("{:g}", point.distance_m),
                                      fmt::format("{:.4f}", point.found), point.judged ? "1" : "0"};
      for (const WalkErrors& errors : {point.before, point.after}) {
        for (const double value :
             {errors.bias_m.value, errors.bias_m.interval.low, errors.bias_m.interval.high, errors.rmse_m,
              errors.above_3_percent, errors.above_10_percent}) {
          row.push_back(fmt::format("{:.6g}", value));
        }
      }
      table.add(std::move(row));
    }
  }
  return table;
}

std::vector<PlotSeries> walk_curves(const WalkSettings& settings, const std::vector<WalkReadout>& readouts) {
  const auto nearest =
      static_cast<std::size_t>(std::ranges::min_element(settings.distances_m) - settings.distances_m.begin());
  std::vector<PlotSeries> series;
  const auto add = [&](const WalkReadout& readout, WalkErrors WalkPoint::*errors, const std::string& label) {
    PlotSeries line{label, {}, {}};
    for (std::size_t i = nearest; i < readout.points.size(); i += settings.distances_m.size()) {
      const WalkPoint& point = readout.points[i];
      if (point.judged) {
        line.x.push_back(point.reflectivity);
        line.y.push_back((point.*errors).bias_m.value * 1e3);
      }
    }
    if (!line.x.empty()) {
      series.push_back(std::move(line));
    }
  };
  for (const WalkReadout& readout : readouts) {
    add(readout, &WalkPoint::before, readout.title);
    if (halves_walk(readout)) {
      add(readout, &WalkPoint::after, readout.title + ", corrected");
    }
  }
  return series;
}

}  // namespace dtof
