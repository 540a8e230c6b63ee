// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "command_line/option_checks.hpp"
#include "commands/commands.hpp"
#include "commands/json_result.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/frame_time.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/sensor/default_parameters.hpp"
#include "dtof/sensor/preset.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

/// What follows from a sensor file, as TOML comments.
std::string consequences(const SensorModel& sensor) {
  return fmt::format(
      "\n# What follows:\n"
      "# T_res {:.4g} ps, {:.4g} mm; unambiguous to {:.4g} m\n"
      "# pulse: FWHM {:.4g} ns, standard deviation with jitter {:.4g} ns\n"
      "# a pixel sees {:.4g} degrees\n"
      "# per pulse and pixel at 1 m, reflectivity 1, 14 klux: {:.4g} signal events, {:.4g} background "
      "events\n"
      "# photon models (--fidelity): {}\n",
      sensor.time_resolution_s() * 1e12, 0.5 * kSpeedOfLight * sensor.time_resolution_s() * 1e3,
      0.5 * kSpeedOfLight * (sensor.integration_time_s - sensor.pulse_fwhm_s), sensor.pulse_fwhm_s * 1e9,
      sensor.pulse_sigma_s() * 1e9, sensor.degrees_per_pixel(), sensor.signal_events(1.0, 1.0),
      sensor.background_events(14.0, 1.0),
      FastPhotonSource::supports(sensor) ? "exact, fast, analytic" : "exact");
}

struct SensorCommand {
  std::string name = "thesis";
  bool keys = false;
  std::optional<double> frame_rate;
  double clock_mhz = 330.0;
  bool json = false;
  std::string command_line;
};

/// A sentence for each read-out that has RTL.
std::string print_fits(const SensorModel& sensor, const FrameBudget& budget) {
  std::string fits;
  for (const Readout readout : kRtlReadouts) {
    const ReadoutParameters parameters = default_parameters(readout, sensor);
    try {
      parameters.validate();
    } catch (const InputError& error) {
      fits += fmt::format("{}: not for this sensor, {}\n", readout_title(readout), error.what());
      continue;
    }
    fits += frame_fit(parameters, sensor.rows, sensor.columns, sensor.acquisitions, budget).sentence + "\n";
  }
  fmt::print("{}", fits);
  return fits;
}

/// What follows from a sensor, as numbers.
void describe(const DescribedSensor& sensor, JsonResult& result) {
  const SensorModel& model = sensor.model;
  result["sensor"] = model.name;
  result["text"] = sensor.text;
  result["columns"] = model.columns;
  result["rows"] = model.rows;
  result["np"] = model.np;
  result["slots"] = model.slots;
  result["acquisitions"] = model.acquisitions;
  result["integration_time_s"] = model.integration_time_s;
  result["time_resolution_s"] = model.time_resolution_s();
  result["pulse_fwhm_s"] = model.pulse_fwhm_s;
  result["degrees_per_pixel"] = model.degrees_per_pixel();
  result["signal_events_at_1m"] = model.signal_events(1.0, 1.0);
  result["background_events_at_14_klux"] = model.background_events(14.0, 1.0);
}

void run_sensor_command(const SensorCommand& options, JsonResult& result) {
  const std::string& name = options.name;
  if (options.keys) {
    result["keys"] = sensor_key_table();
    fmt::print("{}", sensor_key_table());
    return;
  }
  if (options.frame_rate) {
    const DescribedSensor fitted = find_described_sensor(name);
    describe(fitted, result);
    result["fits"] =
        print_fits(fitted.model, {.clock_hz = options.clock_mhz * 1e6, .frames_per_s = *options.frame_rate});
    return;
  }
  const DescribedSensor sensor = find_described_sensor(name);
  describe(sensor, result);
  fmt::print("{}{}", sensor.text, consequences(sensor.model));
}

}  // namespace

void add_sensor_command(CLI::App& app, const std::string& command_line) {
  auto options = std::make_shared<SensorCommand>();
  options->command_line = command_line;
  CLI::App* command = app.add_subcommand(
      "sensor", "Checks and prints a sensor file, to start one's own from, and what follows from it");
  command->add_option("sensor", options->name, "a preset of `dtof list`, or a sensor file (TOML)")
      ->capture_default_str();
  command->add_flag("--keys", options->keys, "the keys of a sensor file instead, with defaults and limits");
  CLI::Option* rate = command
                          ->add_option("--frame-rate", options->frame_rate,
                                       "frames/s: says of each read-out whether its frame fits the clock, "
                                       "and otherwise which change makes it fit")
                          ->check(sensible_frame_rate());
  command->add_option("--clock-mhz", options->clock_mhz, "the array's clock")
      ->check(sensible_clock_mhz())
      ->needs(rate)
      ->capture_default_str();
  JsonResult::add_to(*command, options->json);
  command->callback([options] {
    JsonResult result(options->json, "sensor", options->command_line);
    run_sensor_command(*options, result);
    result.finish();
  });
}

}  // namespace dtof
