// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset.hpp"
#include "hostile_scenes/hostile_report.hpp"
#include "hostile_scenes/hostile_scenes.hpp"

namespace dtof {
namespace {

struct HostileOptions {
  HostileSettings settings;
  ReadoutOptions readout;
  std::string sensor = "thesis";
  std::vector<std::string> scenes = {"room", "planes", "poles", "sky"};
  std::string out = "build/hostile_scenes";
  std::string command_line;
};

/// Names this program and the settings that a cell's figures depend on, so that no figure of another model is
/// taken.
std::string digest(const HostileSettings& settings, const std::string& sensor_text) {
  std::string text = read_file("/proc/self/exe") + sensor_text;
  for (const ReadoutParameters& readout : settings.readouts) {
    text += readout.to_string() + "\n";
  }
  for (const Scene scene : settings.scenes) {
    text += fmt::format("{}\n", scene_name(scene));
  }
  text += fmt::format("{} {} {}", settings.rows, settings.seeds, settings.seed);
  return fmt::format("{:016x}", std::hash<std::string>{}(text));
}

void run_hostile_command(HostileOptions options) {
  HostileSettings& settings = options.settings;
  settings.sensor = find_sensor(options.sensor);
  settings.readouts = options.readout.parameters(kAllReadouts, settings.sensor);
  settings.scenes.clear();
  for (const std::string& name : options.scenes) {
    settings.scenes.push_back(parse_scene(name));
  }
  const std::filesystem::path folder(options.out);
  const bool is_file = std::filesystem::exists(options.sensor);
  settings.store =
      folder / ("cells_" + digest(settings, is_file ? read_file(options.sensor) : options.sensor));
  const HostileScenes study = run_hostile_scenes(settings);
  write_page(folder, "hostile_scenes", "hostile_scenes", hostile_page(settings, study, options.command_line));
  create_output_folder(folder / "data");
  write_gzip_file(folder / "data/hostile_scenes.csv.gz", hostile_csv(settings, study).csv());
  const std::vector<PlotSeries> curves = hostile_curves(settings, study);
  if (!curves.empty()) {
    write_plot(folder / "hostile_scenes.svg", curves,
               {.title = fmt::format("Detection over false alarms, clear, {:g} klux, sensor {}",
                                     std::ranges::max(settings.klux), settings.sensor.name),
                .x_label = "P_fa: pixels without a target that pass the threshold, in %",
                .y_label = "P_d: pixels with a target that pass and are within 3 %, in %",
                .logarithmic_x = true,
                .markers = false});
  }
  fmt::print("The report is {}\n", (folder / "hostile_scenes.md").string());
}

}  // namespace

void add_hostile_scenes_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<HostileOptions>();
  options->command_line = command_line;
  HostileSettings& settings = options->settings;
  settings.conditions = {std::string(kClear)};
  for (const Condition& condition : conditions()) {
    settings.conditions.push_back(condition.name);
  }
  CLI::App* command = app.add_subcommand(
      "hostile-scenes",
      "What each read-out survives: glass, fog, other lasers, motion, skew, and no target at all");
  command
      ->add_option("--condition", settings.conditions,
                   "conditions of `dtof list`, and clear, which must be among them")
      ->capture_default_str();
  command->add_option("-k,--klux", settings.klux, "background light in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--scene", options->scenes, "scenes from `dtof list`")->capture_default_str();
  command->add_option("--rows", settings.rows, "rows of each scene")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--seeds", settings.seeds, "frames of each scene with other photons")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command
      ->add_option("--false-alarms", settings.false_alarms,
                   "share of a clear sky's pixels that the threshold of confidence lets pass")
      ->capture_default_str();
  add_sensor_option(*command, options->sensor);
  options->readout.add_to(*command);
  add_study_options(*command, settings.seed, settings.threads, options->out);
  command->callback([options] { run_hostile_command(*options); });
}

}  // namespace dtof
