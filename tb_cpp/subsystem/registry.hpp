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

/// A compiled subsystem: the array in it and how to make its model.
struct CompiledSubsystem {
  RtlConfiguration configuration;
  SubsystemModelFactory factory;
};

/// Called by each compiled subsystem when the program starts; returns true.
bool register_subsystem(const RtlConfiguration& configuration, SubsystemModelFactory factory);

/// Subsystems linked into this program, by their read-outs' numbers.
std::vector<CompiledSubsystem> compiled_subsystems();

/// Those with these parameters (parameters that the read-out does not use are not compared) and at least so
/// many rows that read the columns `selected` of a source of `source_columns`: of poolPointer one for each
/// engine that has one of them, with just so many rows and columns, in their order, else one for all. Their
/// configurations have the gate, the shares and S1 of `parameters`. Throws InputError naming what is
/// compiled.
std::vector<CompiledSubsystem> find_subsystems(const ReadoutParameters& parameters, int rows,
                                               int source_columns, std::span<const int> selected);

}  // namespace dtof
