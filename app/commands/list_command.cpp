// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "commands/commands.hpp"
#include "commands/json_result.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/scene/scene.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset.hpp"
#include "rtl/registry.hpp"
#include "subsystem/registry.hpp"

namespace dtof {

namespace {

nlohmann::ordered_json described(std::string_view name, std::string_view summary) {
  return {{"name", name}, {"summary", summary}};
}

/// The same as members of a JSON object.
void describe(JsonResult& result) {
  for (const Readout readout : kAllReadouts) {
    result["readouts"].push_back(described(readout_name(readout), readout_summary(readout)));
  }
  for (const std::string_view name : preset_names()) {
    const SensorModel sensor = parse_preset(name);
    result["presets"].push_back({{"name", name},
                                 {"columns", sensor.columns},
                                 {"rows", sensor.rows},
                                 {"acquisitions", sensor.acquisitions},
                                 {"signal_events_at_1m", sensor.signal_events(1.0, 1.0)},
                                 {"background_events_at_14_klux", sensor.background_events(14.0, 1.0)}});
  }
  for (const Condition& condition : conditions()) {
    result["conditions"].push_back(described(condition.name, condition.says));
  }
  for (const Scene scene : kAllScenes) {
    result["scenes"].push_back(described(scene_name(scene), scene_summary(scene)));
  }
  for (const RtlConfiguration& configuration : compiled_rtl_configurations()) {
    result["hardware"].push_back(configuration.to_string());
  }
  result["subsystems"] = nlohmann::ordered_json::array();
  for (const CompiledSubsystem& subsystem : compiled_subsystems()) {
    result["subsystems"].push_back(subsystem.configuration.to_string());
  }
}

void print_list() {
  fmt::print("Read-outs (--readout):\n");
  for (const Readout readout : kAllReadouts) {
    fmt::print("  {:<16} {}\n", readout_name(readout), readout_summary(readout));
    fmt::print("  {:<16}   defaults: {}\n", "", ReadoutParameters::defaults(readout).to_string());
  }
  fmt::print("\nPresets (--sensor), per pixel and pulse at 1 m, reflectivity 1, 14 klux:\n");
  for (const std::string_view name : preset_names()) {
    const SensorModel sensor = parse_preset(name);
    const bool assumed = preset_text(name).find("# assumption") != std::string_view::npos;
    fmt::print("  {:<16} {:.3f} signal events, {:.3f} background events, {} acquisitions per frame{}\n", name,
               sensor.signal_events(1.0, 1.0), sensor.background_events(14.0, 1.0), sensor.acquisitions,
               assumed ? fmt::format("; light assumed (dtof sensor {})", name) : "");
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
}

}  // namespace

void add_list_command(CLI::App& app, const std::string& command_line) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("list", "Shows read-outs, presets of sensors, scenes and compiled hardware");
  JsonResult::add_to(*command, *json);
  command->callback([json, command_line] {
    JsonResult result(*json, "list", command_line);
    print_list();
    describe(result);
    result.finish();
  });
}

}  // namespace dtof
