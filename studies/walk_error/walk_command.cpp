// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "walk_error/walk_report.hpp"
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

  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  write_file(folder / "walk_error.csv", walk_csv(readouts).csv());
  write_page(folder, "walk_error", "walk_error", walk_page(settings, readouts, options.command_line));
  write_plot(
      folder / "walk_error.svg", walk_curves(settings, readouts),
      {.title = fmt::format("Bias in mm over reflectivity: flat target at {:g} m, {:g} klux, sensor {}",
                            std::ranges::min(settings.distances_m), settings.klux, settings.sensor.name),
       .x_label = "reflectivity",
       .y_label = "bias, mm",
       .y_limits = {0.0},
       .logarithmic_x = true});
  fmt::print("{}\nSeed {}. The report is {}\n", walk_summary(readouts).markdown(), options.seed,
             (folder / "walk_error.md").string());
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
