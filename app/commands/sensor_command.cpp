// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands/commands.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/fast_photon_source.hpp"
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

void run_sensor_command(const std::string& name, bool keys) {
  if (keys) {
    fmt::print("{}", sensor_key_table());
    return;
  }
  const DescribedSensor sensor = find_described_sensor(name);
  fmt::print("{}{}", sensor.text, consequences(sensor.model));
}

}  // namespace

void add_sensor_command(CLI::App& app) {
  auto name = std::make_shared<std::string>("thesis");
  auto keys = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "sensor", "Checks and prints a sensor file, to start one's own from, and what follows from it");
  command->add_option("sensor", *name, "a preset of `dtof list`, or a sensor file (TOML)")
      ->capture_default_str();
  command->add_flag("--keys", *keys, "the keys of a sensor file instead, with defaults and limits");
  command->callback([name, keys] { run_sensor_command(*name, *keys); });
}

}  // namespace dtof
