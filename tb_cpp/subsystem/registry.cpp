// SPDX-License-Identifier: Apache-2.0
#include "subsystem/registry.hpp"

#include <algorithm>
#include <utility>

namespace dtof {
namespace {

std::vector<CompiledSubsystem>& registry() {
  static std::vector<CompiledSubsystem> entries;
  return entries;
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

}  // namespace dtof
