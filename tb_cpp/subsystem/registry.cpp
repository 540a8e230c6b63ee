// SPDX-License-Identifier: Apache-2.0
#include "subsystem/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/select_columns.hpp"

namespace dtof {
namespace {

std::vector<CompiledSubsystem>& registry() {
  static std::vector<CompiledSubsystem> entries;
  return entries;
}

// The gate, a pool read-out's schedule, TEMPLATE and S1 are set with every frame.
ReadoutParameters compiled_parameters(ReadoutParameters parameters) {
  const PoolPointerParameters defaults = PoolPointerParameters::defaults(parameters.readout);
  parameters.pool.coarse_share = defaults.coarse_share;
  parameters.pool.track_share = defaults.track_share;
  parameters.pool.smooth = defaults.smooth;
  parameters.pool.coarse_template = defaults.coarse_template;
  parameters.time_gate.reset();
  return parameters;
}

/// `columns`: of an engine; 0 if any number will do.
CompiledSubsystem find_subsystem(const ReadoutParameters& parameters, int rows, int columns) {
  const std::string wanted = compiled_parameters(parameters).to_string();
  std::string compiled;
  for (CompiledSubsystem& entry : compiled_subsystems()) {
    // All have a time gate, closed to nothing where it is not asked for.
    if (compiled_parameters(entry.configuration.parameters).to_string() == wanted &&
        entry.configuration.pixels_per_sram >= rows &&
        (columns == 0 ||
         (entry.configuration.sram_num == columns && entry.configuration.pixels_per_sram == rows))) {
      entry.configuration.parameters.time_gate = parameters.time_gate;
      entry.configuration.parameters.pool = parameters.pool;
      return entry;
    }
    compiled += fmt::format("{}{}", compiled.empty() ? "" : " | ", entry.configuration.to_string());
  }
  if (compiled.empty()) {
    throw InputError("this program has no subsystems, dtof-full has them (make full)");
  }
  const std::string engine = columns == 0 ? "" : fmt::format(" and an engine of just {} columns", columns);
  throw InputError(fmt::format("no subsystem is compiled for {} with at least {} rows{}; compiled are: {}",
                               wanted, rows, engine, compiled));
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

std::vector<CompiledSubsystem> find_subsystems(const ReadoutParameters& parameters, int rows,
                                               int source_columns, std::span<const int> selected) {
  const int together = parameters.columns_together();
  if (together == 1) {
    return {find_subsystem(parameters, rows, 0)};
  }
  std::vector<CompiledSubsystem> found;
  for (const ColumnGroup& engine : column_groups(selected, together, source_columns)) {
    found.push_back(find_subsystem(parameters, rows, engine.count));
  }
  return found;
}

}  // namespace dtof
