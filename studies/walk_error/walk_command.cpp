// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/frame/flat_calibration.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "walk_error/walk_study.hpp"

namespace dtof {
namespace {

struct WalkOptions {
  ReadoutOptions readout;
  SensorOptions sensor;
  std::vector<double> reflectivities = {0.02, 0.05, 0.1, 0.2, 0.5, 1.0};
  std::vector<double> distances_m = {0.3, 0.5, 1.0, 1.5, 2.0, 3.0};
  int columns = 8;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string out = "build/walk";
  std::string command_line;
};

/// Mean over the judged points, in per cent.
double above_3_percent(const WalkReadout& readout, WalkErrors WalkPoint::*errors) {
  double sum = 0.0;
  for (const WalkPoint& point : readout.points) {
    sum += point.judged ? (point.*errors).above_3_percent : 0.0;
  }
  return readout.judged() == 0 ? 0.0 : 100.0 * sum / static_cast<double>(readout.judged());
}

Table summary_table(const std::vector<WalkReadout>& readouts) {
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

/// Whether the correction takes at least half of the walk away.
bool halves_walk(const WalkReadout& readout) {
  return readout.walk_after_m() <= 0.5 * readout.walk_before_m();
}

std::string plus_minus(const Estimate& bias) {
  return fmt::format("{:.1f} +- {:.1f}", bias.value * 1e3, 500.0 * (bias.interval.high - bias.interval.low));
}

/// Reflectivities down, distances across.
Table bias_table(const WalkReadout& readout, const WalkOptions& options) {
  std::vector<std::string> header = {"reflectivity"};
  for (const double distance : options.distances_m) {
    header.push_back(fmt::format("{:g} m", distance));
  }
  Table table(std::move(header));
  for (std::size_t i = 0; i < options.reflectivities.size(); ++i) {
    std::vector<std::string> row = {fmt::format("{:g}", options.reflectivities[i])};
    for (std::size_t d = 0; d < options.distances_m.size(); ++d) {
      const WalkPoint& point = readout.points[i * options.distances_m.size() + d];
      row.push_back(point.judged ? fmt::format("{} -> {}", plus_minus(point.before.bias_m),
                                               plus_minus(point.after.bias_m))
                                 : "-");
    }
    table.add(std::move(row));
  }
  return table;
}

Table points_csv(const std::vector<WalkReadout>& readouts) {
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

/// What the correction does, as computed.
std::string verdict(const std::vector<WalkReadout>& readouts) {
  std::vector<std::string> halved;
  std::vector<std::string> reduced;
  std::vector<std::string> others;
  std::vector<std::string> unjudged;
  for (const WalkReadout& readout : readouts) {
    const double before = readout.walk_before_m();
    const double after = readout.walk_after_m();
    if (before == 0.0) {  // no distance with two reflectivities that could be judged
      unjudged.push_back(readout.title);
      continue;
    }
    std::vector<std::string>& group = halves_walk(readout) ? halved : after < before ? reduced : others;
    group.push_back(fmt::format("{} ({:.0f} to {:.0f} mm)", readout.title, before * 1e3, after * 1e3));
  }
  std::string text;
  const auto say = [&](const char* what, const std::vector<std::string>& names) {
    if (!names.empty()) {
      text += fmt::format("* {}: {}.\n", what, fmt::join(names, ", "));
    }
  };
  say("The walk is at least halved", halved);
  say("It is reduced by less than half", reduced);
  say("It is not reduced", others);
  say("It could not be judged", unjudged);
  return text;
}

/// Before the correction at the nearest distance, and after it where it halves the walk.
void write_picture(const std::filesystem::path& path, const std::vector<WalkReadout>& readouts,
                   const WalkOptions& options, const std::string& sensor) {
  const auto nearest =
      static_cast<std::size_t>(std::ranges::min_element(options.distances_m) - options.distances_m.begin());
  std::vector<PlotSeries> series;
  const auto add = [&](const WalkReadout& readout, WalkErrors WalkPoint::*errors, const std::string& label) {
    PlotSeries line{label, {}, {}};
    for (std::size_t i = nearest; i < readout.points.size(); i += options.distances_m.size()) {
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
  write_plot(
      path, series,
      {.title = fmt::format("Bias in mm over reflectivity: flat target at {:g} m, {:g} klux, sensor {}",
                            options.distances_m[nearest], options.sensor.klux, sensor),
       .x_label = "reflectivity",
       .y_label = "bias, mm",
       .y_limits = {0.0},
       .logarithmic_x = true});
}

void run_walk_command(const WalkOptions& options) {
  WalkSettings settings;
  settings.readouts = options.readout.parameters(kAllReadouts, options.sensor.described());
  settings.sensor = options.sensor.model(settings.readouts.front().np, settings.readouts.front().slots);
  settings.klux = options.sensor.klux;
  settings.reflectivities = options.reflectivities;
  settings.distances_m = options.distances_m;
  settings.columns = options.columns;
  settings.seed = options.seed;
  settings.threads = options.threads;
  const std::vector<WalkReadout> readouts = run_walk_study(settings);

  std::string report = fmt::format(
      "# Walk error\n\n"
      "A bright target fills the TDC's {} slots early (pile-up), so that its pulse seems nearer. Flat "
      "targets, {} pixels "
      "at each reflectivity and distance, {:g} klux, sensor {}, {} acquisitions, seed {}.\n\n"
      "* Before: the look-up table is fitted on {}.\n"
      "* After: the table's mean error for the result's own confidence and distance is taken away "
      "(`host/walk_correction.hpp`), fitted on eight other reflectivities in the same range, from other "
      "photons.\n"
      "* Bias is the mean error of the pixels that found the target: their distance by the table is within "
      "the pulse's width of the truth. A point at which fewer than half of the pixels found the target is "
      "not judged. Intervals (95 %) come from the columns' means. Better, worse: points at which the bias is "
      "smaller or larger after the correction, by more than both intervals.\n"
      "* Walk: at each distance the largest bias minus the smallest bias over the reflectivities; the table "
      "has the rms over the distances. Rms bias and shares are over the judged points.\n"
      "* At largest confidence: share of the results, from the targets that the correction is fitted on, "
      "whose confidence has its largest value. The correction cannot distinguish these results.\n\n"
      "![Bias over reflectivity at the nearest distance](walk_error.svg)\n\n{}\n{}\n"
      "All points with shares of errors: [walk_error.csv](walk_error.csv). Bias in mm, before -> after:\n",
      settings.sensor.slots, options.columns * FlatCalibration::kPixels, options.sensor.klux,
      settings.sensor.name, settings.sensor.acquisitions, options.seed,
      FlatCalibration(settings.sensor).description(), summary_table(readouts).markdown(), verdict(readouts));
  for (const WalkReadout& readout : readouts) {
    report += fmt::format("\n## {}\n\n{}", readout.title, bias_table(readout, options).markdown());
  }
  report += fmt::format("\nCommand: `{}`\n", options.command_line);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  write_file(folder / "walk_error.csv", points_csv(readouts).csv());
  write_file(folder / "walk_error.md", report);
  write_picture(folder / "walk_error.svg", readouts, options, settings.sensor.name);
  fmt::print("{}\n{}\nSeed {}. Written to {}\n", summary_table(readouts).markdown(), verdict(readouts),
             options.seed, (folder / "walk_error.md").string());
}

}  // namespace

void add_walk_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<WalkOptions>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "walk", "Walk error: bias over reflectivity, and what the host corrects by confidence");
  command->add_option("--reflectivities", options->reflectivities, "reflectivities to judge, two or more")
      ->check(sensible_reflectivity())
      ->capture_default_str();
  command->add_option("-d,--distances", options->distances_m, "distances to judge, m")->capture_default_str();
  command
      ->add_option("--columns", options->columns, "columns of 160 pixels for each reflectivity and distance")
      ->check(CLI::Range(4, 10'000))
      ->capture_default_str();
  options->sensor.add_to(*command);
  options->readout.add_to(*command);
  add_study_options(*command, options->seed, options->threads, options->out);
  command->callback([options, command] {
    for (const char* option : {"--fidelity", "--tolerance"}) {
      refuse_without_effect(*command, option, "walk error is measured with exact photons");
    }
    options->sensor.refuse_options_without_effect(*command);
    run_walk_command(*options);
  });
}

}  // namespace dtof
