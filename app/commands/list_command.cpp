// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

#include "commands/commands.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset.hpp"
#include "rtl/registry.hpp"
#include "subsystem/registry.hpp"

namespace dtof {

void add_list_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("list", "Shows read-outs, presets of sensors, scenes and compiled hardware");
  command->callback([] {
    fmt::print("Read-outs (--readout):\n");
    for (const Readout readout : kAllReadouts) {
      fmt::print("  {:<16} {}\n", readout_name(readout), readout_summary(readout));
      fmt::print("  {:<16}   defaults: {}\n", "", ReadoutParameters::defaults(readout).to_string());
    }
    fmt::print("\nPresets (--sensor), per pixel and pulse at 1 m, reflectivity 1, 14 klux:\n");
    for (const std::string_view name : preset_names()) {
      const SensorModel sensor = parse_preset(name);
      const bool assumed = preset_text(name).find("# assumption") != std::string_view::npos;
      fmt::print("  {:<16} {:.3f} signal events, {:.3f} background events, {} acquisitions per frame{}\n",
                 name, sensor.signal_events(1.0, 1.0), sensor.background_events(14.0, 1.0),
                 sensor.acquisitions, assumed ? fmt::format("; light assumed (dtof sensor {})", name) : "");
    }
    fmt::print("\nConditions (--sensor PRESET+CONDITION):\n");
    for (const Condition& condition : conditions()) {
      fmt::print("  {:<20} {}\n", condition.name, condition.says);
    }
    fmt::print("\nScenes (--scene):\n");
    for (const Scene scene : kAllScenes) {
      fmt::print("  {:<16} {}\n", scene_name(scene), scene_summary(scene));
    }
    fmt::print("\nHardware compiled into this program (--engine rtl):\n");
    for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
      fmt::print("  {}\n", configuration.to_string());
    }
    fmt::print("\nSubsystems compiled into this program (--engine subsystem):\n");
    const std::vector<CompiledSubsystem> subsystems = compiled_subsystems();
    if (subsystems.empty()) {
      fmt::print("  none; dtof-full has them (make full)\n");
    }
    for (const CompiledSubsystem& subsystem : subsystems) {
      fmt::print("  {}\n", subsystem.configuration.to_string());
    }
  });
}

}  // namespace dtof
