// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
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

/// The one with these parameters (parameters that the read-out does not use are not compared) and at least so
/// many rows. Its configuration has the gate and the shares of `parameters`. Throws InputError naming what is
/// compiled.
CompiledSubsystem find_subsystem(const ReadoutParameters& parameters, int rows);

}  // namespace dtof
