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

}  // namespace dtof
