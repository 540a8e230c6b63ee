// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "rtl/configuration.hpp"
#include "subsystem/subsystem_model.hpp"

class VerilatedContext;

namespace dtof {

using SubsystemModelFactory = std::function<std::unique_ptr<SubsystemModel>(VerilatedContext&)>;

/// A compiled subsystem: its array and the function that makes its model.
struct CompiledSubsystem {
  RtlConfiguration configuration;
  SubsystemModelFactory factory;
};

/// Registers a compiled subsystem. Each subsystem calls this when the program starts. Returns true.
bool register_subsystem(const RtlConfiguration& configuration, SubsystemModelFactory factory);

/// Subsystems linked into this program, sorted by the number of their read-out.
std::vector<CompiledSubsystem> compiled_subsystems();

/// Returns the compiled subsystems that read the columns `selected` of a source of `source_columns` columns
/// and `rows` rows with these parameters (those that the read-out uses). For poolPointer one for each engine
/// with a selected column, with exactly these rows and columns, in order; otherwise a single one with at
/// least `rows` rows. Their configurations have the gate, the shares and S1 of `parameters`. Throws
/// InputError that lists what is compiled.
std::vector<CompiledSubsystem> find_subsystems(const ReadoutParameters& parameters, int rows,
                                               int source_columns, std::span<const int> selected);

}  // namespace dtof
