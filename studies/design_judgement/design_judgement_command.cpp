// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "design_judgement/design_judgement.hpp"
#include "design_judgement/design_judgement_report.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"

namespace dtof {
namespace {

struct DesignJudgementOptions {
  JudgementSettings settings;
  std::string out = "build/design_judgement";
  std::string command_line;
};

/// Names this program and the settings that a judgement depends on, so that no other judgement is taken. The
/// number of sensors and of threads changes no judgement.
std::string digest(const JudgementSettings& settings) {
  const std::string text =
      read_file("/proc/self/exe") + fmt::format("{} {} {} {} {} {} {} {}", settings.ranges.most_columns,
                                                settings.ranges.most_rows, settings.ranges.most_acquisitions,
                                                settings.seed, settings.sweep_pixels, settings.final_pixels,
                                                settings.final_seeds, settings.finalists);
  return fmt::format("{:016x}", std::hash<std::string>{}(text));
}

void run_design_judgement(DesignJudgementOptions options) {
  JudgementSettings& settings = options.settings;
  const std::filesystem::path folder(options.out);
  settings.store = folder / ("judged_" + digest(settings));
  settings.on_judged = [&](int number, const SensorJudgement& judgement) {
    const Estimate& ratio = judgement.ratio;
    fmt::print("Sensor {} of {}: {}, ratio {:.3f} [{:.3f}, {:.3f}] to {}\n", number, settings.sensors,
               judgement.recommended.name, ratio.value, ratio.interval.low, ratio.interval.high,
               judgement.best.name);
    std::fflush(stdout);
  };
  const std::vector<JudgedSensor> judged = judge_designs(settings);
  create_output_folder(folder / "sensors");
  for (const JudgedSensor& one : judged) {
    write_file(folder / "sensors" / (one.sensor.request.bench.sensor.name + ".toml"), one.sensor.toml);
  }
  write_page(folder, "design_judgement", "design_judgement",
             judgement_page(settings, judged, options.command_line));
  write_file(folder / "design_judgement.csv", judgement_csv(judged).csv());
  write_plot(folder / "design_judgement.svg", judgement_curves(judged),
             {.title = "Recommendation of dtof design: pixels off by more than 3 %, in the worst light",
              .x_label = "best of the full sweep, in %",
              .y_label = "recommendation, in %",
              .logarithmic_y = true,
              .logarithmic_x = true});
  fmt::print("The report is {}\n", (folder / "design_judgement.md").string());
}

}  // namespace

void add_design_judgement_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<DesignJudgementOptions>();
  options->command_line = command_line;
  JudgementSettings& settings = options->settings;
  CLI::App* command = app.add_subcommand(
      "design-judgement",
      "How near dtof design's recommendation is to the best of a full sweep, for random sensors");
  command->add_option("--sensors", settings.sensors, "random sensors to judge")
      ->check(CLI::Range(1, 99))
      ->capture_default_str();
  command->add_option("--most-columns", settings.ranges.most_columns, "columns of the largest sensor")
      ->check(CLI::Range(kLeastColumns, 4096))
      ->capture_default_str();
  command->add_option("--most-rows", settings.ranges.most_rows, "rows of the largest sensor")
      ->check(CLI::Range(kLeastRows, 4096))
      ->capture_default_str();
  command
      ->add_option("--most-acquisitions", settings.ranges.most_acquisitions,
                   "acquisitions of the longest frame")
      ->check(CLI::Range(kLeastAcquisitions, 1'048'575U))
      ->capture_default_str();
  command->add_option("--sweep-pixels", settings.sweep_pixels, "pixels of a candidate and light in the sweep")
      ->check(CLI::Range(1.0, 1e9))
      ->capture_default_str();
  command->add_option("--final-pixels", settings.final_pixels, "pixels of a finalist, light and seed")
      ->check(CLI::Range(1.0, 1e9))
      ->capture_default_str();
  command->add_option("--final-seeds", settings.final_seeds, "seeds of the final")
      ->check(CLI::Range(2, 900))
      ->capture_default_str();
  command->add_option("--finalists", settings.finalists, "candidates of the sweep in the final")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  add_study_options(*command, settings.seed, settings.threads, options->out);
  command->callback([options] { run_design_judgement(*options); });
}

}  // namespace dtof
