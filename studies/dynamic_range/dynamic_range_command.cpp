// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
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
#include "dtof/sensor/preset.hpp"
#include "dynamic_range/dynamic_range.hpp"
#include "dynamic_range/dynamic_range_report.hpp"

namespace dtof {
namespace {

struct DynamicRangeOptions {
  RangeSettings settings;
  ReadoutOptions readout;
  std::string sensor = "thesis";
  std::vector<std::string> scenes = {"room", "planes", "poles"};
  std::string out = "build/dynamic_range";
  std::string command_line;
};

/// Names this program and the settings that a cell's figures depend on, so that no figure of another model is
/// taken.
std::string digest(const RangeSettings& settings, const std::string& sensor_text) {
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

void run_dynamic_range_command(DynamicRangeOptions options) {
  RangeSettings& settings = options.settings;
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
  const DynamicRange study = run_dynamic_range(settings);
  create_output_folder(folder);
  write_page(folder, "dynamic_range", "dynamic_range",
             dynamic_range_page(settings, study, options.command_line));
  create_output_folder(folder / "data");
  write_gzip_file(folder / "data/dynamic_range.csv.gz", dynamic_range_csv(study).csv());
  write_plot(
      folder / "dynamic_range.svg", dynamic_range_curves(settings, study),
      {.title = fmt::format("Pixels off by more than 3 %, in %: {} together, {:g} klux, sensor {}",
                            fmt::join(options.scenes, ", "), pictured_klux(settings), settings.sensor.name),
       .x_label = "acquisitions",
       .y_label = "pixels above 3 %, in %",
       .logarithmic_x = true});
  fmt::print("{} of the lists' entries are about pool read-outs. The report is {}\n", pool_findings(study),
             (folder / "dynamic_range.md").string());
}

}  // namespace

void add_dynamic_range_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<DynamicRangeOptions>();
  options->command_line = command_line;
  RangeSettings& settings = options->settings;
  settings.acquisitions = {8, 64, 333, 1000, 3333, 10'000, 33'333, 65'535};
  settings.klux = {0.0, 2.0, 14.0, 50.0, 100.0, 200.0};
  settings.signals = {0.1, 1.0, 10.0};
  CLI::App* command = app.add_subcommand(
      "dynamic-range",
      "Does more light make a read-out worse? Errors over acquisitions, sunlight and signal");
  command
      ->add_option("-a,--acquisitions", settings.acquisitions, "laser pulses of a frame, two or more numbers")
      ->check(CLI::Range(1U, 65'535U))
      ->capture_default_str();
  command->add_option("-k,--klux", settings.klux, "background light in klux")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--signals", settings.signals, "signal events, as multiples of the sensor's")
      ->check(CLI::Range(1e-3, 1e3))
      ->capture_default_str();
  command->add_option("--scene", options->scenes, "scenes from `dtof list`")->capture_default_str();
  command->add_option("--rows", settings.rows, "rows of each scene")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--seeds", settings.seeds, "frames of each scene with other photons")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  add_sensor_option(*command, options->sensor);
  options->readout.add_to(*command);
  add_study_options(*command, settings.seed, settings.threads, options->out);
  command->callback([options] { run_dynamic_range_command(*options); });
}

}  // namespace dtof
