// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "accuracy/accuracy_study.hpp"
#include "command_line/option_checks.hpp"
#include "command_line/options.hpp"
#include "common/commands.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/atomic_file.hpp"
#include "dtof/io/output_folder.hpp"
#include "dtof/sensor/preset.hpp"
#include "sensor_effects/sensor_effects.hpp"

namespace dtof {
namespace {

struct SensorEffectsOptions {
  RunSettings run;
  std::string clean = "thesis";
  std::vector<std::string> others;
  std::vector<double> klux = {2.0, 14.0, 50.0};
  std::vector<double> distances_m = {0.33, 1.03, 2.03, 3.03};  // between those of the calibration
  ReadoutOptions readouts;
  int frames = 1000;
  std::string out = "build/sensor_effects";
  std::string command_line;
};

StudySettings settings_of(const SensorEffectsOptions& options, const SensorModel& sensor) {
  StudySettings settings;
  settings.sensor = sensor;
  settings.readouts = options.readouts.parameters(kAllReadouts, sensor);
  settings.reflectivity = sensor.default_reflectivity;
  settings.distances_m = options.distances_m;
  settings.frames = options.frames;
  settings.run = options.run;
  settings.command = options.command_line;
  for (const double distance_m : settings.distances_m) {
    SensorOptions::require_in_range(sensor, distance_m, "--distances");
  }
  return settings;
}

SensorAccuracy measure(const SensorEffectsOptions& options, const SensorModel& sensor) {
  SensorAccuracy accuracy{sensor, {}};
  StudySettings settings = settings_of(options, sensor);
  for (const double klux : options.klux) {
    settings.klux = klux;
    const AccuracyStudy study = run_accuracy_study(settings);
    accuracy.points.insert(accuracy.points.end(), study.points.begin(), study.points.end());
  }
  return accuracy;
}

void run_sensor_effects_command(const SensorEffectsOptions& options) {
  const SensorModel clean_sensor = find_sensor(options.clean);
  std::vector<SensorModel> sensors;
  sensors.reserve(options.others.size());
  for (const std::string& name : options.others) {
    sensors.push_back(find_sensor(name));
    (void)settings_of(options, sensors.back());  // refused before the first is measured
  }
  const std::filesystem::path folder(options.out);
  create_output_folder(folder);
  SensorEffects effects{measure(options, clean_sensor), {}, options.klux, options.frames, options.run.seed};
  for (const SensorModel& sensor : sensors) {
    effects.others.push_back(measure(options, sensor));
  }
  write_file(folder / "sensor_effects.csv", effects_csv(effects.clean, effects.others).csv());
  write_page(folder, "sensor_effects", "sensor_effects", sensor_effects_page(effects, options.command_line));
  fmt::print("{}\nThe report is {}\n", effect_overview(effects.clean, effects.others).markdown(),
             (folder / "sensor_effects.md").string());
}

}  // namespace

void add_sensor_effects_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<SensorEffectsOptions>();
  options->command_line = command_line;
  CLI::App* command =
      app.add_subcommand("sensor-effects", "What the effects of real sensors do to each read-out's accuracy");
  command
      ->add_option("--against", options->clean, "the clean sensor: a preset of `dtof list`, or a sensor file")
      ->capture_default_str();
  command
      ->add_option("sensors", options->others, "sensor files (docs/user/sensor_file.md) to compare with it")
      ->required();
  command->add_option("-k,--klux", options->klux, "background light in klux, one or more")
      ->check(sensible_klux())
      ->capture_default_str();
  command->add_option("--distances", options->distances_m, "distances of the targets in m, one or more")
      ->capture_default_str();
  command
      ->add_option("-r,--readout", options->readouts.readouts,
                   "read-outs: all (those of the thesis), or names from `dtof list`, separated by commas")
      ->capture_default_str();
  command->add_option("--frames", options->frames, "frames at each distance and light")
      ->check(CLI::Range(4, 1'000'000))
      ->capture_default_str();
  add_study_options(*command, options->run.seed, options->run.threads, options->out);
  command->callback([options] { run_sensor_effects_command(*options); });
}

}  // namespace dtof
