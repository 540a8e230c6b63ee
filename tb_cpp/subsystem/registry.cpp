// SPDX-License-Identifier: Apache-2.0
#include "subsystem/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace dtof {
namespace {

std::vector<CompiledSubsystem>& registry() {
  static std::vector<CompiledSubsystem> entries;
  return entries;
}

// The gate and a pool read-out's schedule are set with every frame.
ReadoutParameters compiled_parameters(ReadoutParameters parameters) {
  const PoolPointerParameters defaults = PoolPointerParameters::defaults(parameters.readout);
  parameters.pool.coarse_share = defaults.coarse_share;
  parameters.pool.track_share = defaults.track_share;
  parameters.time_gate.reset();
  return parameters;
}

}  // namespace

bool register_subsystem(const RtlConfiguration& configuration, SubsystemModelFactory factory) {
  registry().push_back({configuration, std::move(factory)});
  return true;
}

std::vector<CompiledSubsystem> compiled_subsystems() {
  std::vector<CompiledSubsystem> entries = registry();
  std::ranges::sort(entries, {},
                    [](const CompiledSubsystem& entry) { return entry.configuration.parameters.readout; });
  return entries;
}

CompiledSubsystem find_subsystem(const ReadoutParameters& parameters, int rows) {
  const std::string wanted = compiled_parameters(parameters).to_string();
  std::string compiled;
  for (CompiledSubsystem& entry : compiled_subsystems()) {
    // All have a time gate, closed to nothing where it is not asked for.
    if (compiled_parameters(entry.configuration.parameters).to_string() == wanted &&
        entry.configuration.pixels_per_sram >= rows) {
      entry.configuration.parameters.time_gate = parameters.time_gate;
      entry.configuration.parameters.pool = parameters.pool;
      return entry;
    }
    compiled += fmt::format("{}{}", compiled.empty() ? "" : " | ", entry.configuration.to_string());
  }
  if (compiled.empty()) {
    throw InputError("this program has no subsystems, dtof-full has them (make full)");
  }
  throw InputError(fmt::format("no subsystem is compiled for {} with at least {} rows; compiled are: {}",
                               wanted, rows, compiled));
}

}  // namespace dtof
