// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "detection/detection.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/sensor/preset.hpp"

namespace dtof {
namespace {

struct DetectionOptions {
  DetectionSettings settings;
  ReadoutOptions readout;
  std::string sensor = "thesis";
  std::string out = "build/detection";
  std::string command_line;
};

void run_detection_command(DetectionOptions options) {
  DetectionSettings& settings = options.settings;
  settings.sensor = find_sensor(options.sensor);
  settings.readouts = options.readout.parameters(kAllReadouts, settings.sensor);
  const std::filesystem::path folder(options.out);
  create_output_folder(folder / "data");
  const std::vector<ReadoutDetection> study = run_detection(settings);
  write_page(folder, "detection", "detection", detection_page(settings, study, options.command_line));
  write_gzip_file(folder / "data/detection.csv.gz", detection_csv(study).csv());
  write_plot(
      folder / "detection.svg", detection_curves(settings, study),
      {.title = fmt::format(
           "Detection of a wall of reflectivity {:g}, {:g} klux, {:g} false alarms, sensor {}",
           settings.wall_reflectivity, detection_klux(settings), settings.false_alarms, settings.sensor.name),
       .x_label = "distance in m",
       .y_label = "pixels that pass the threshold and are right, in %"});
  fmt::print("The report is {}\n", (folder / "detection.md").string());
}

}  // namespace

void add_detection_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<DetectionOptions>();
  options->command_line = command_line;
  DetectionSettings& settings = options->settings;
  CLI::App* command = app.add_subcommand(
      "detection", "Whether there is a target at all: detection at one threshold for every light and sky");
  command->add_option("-k,--klux", settings.klux, "background light in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--distance", settings.distances_m, "distances of the wall in m")
      ->capture_default_str();
  command->add_option("--seeds", settings.seeds, "frames of each wall and sky")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--false-alarms", settings.false_alarms, "share of any sky's pixels that pass")
      ->capture_default_str();
  add_sensor_option(*command, options->sensor);
  options->readout.add_to(*command);
  add_study_options(*command, settings.seed, settings.threads, options->out);
  command->callback([options] { run_detection_command(*options); });
}

}  // namespace dtof
