// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "fault_metrics/gate_netlist.hpp"

namespace dtof {

/// False if Yosys is not installed: the tests that need netlists are skipped.
bool has_yosys();

/// Netlist that scripts/fault_netlists.py writes, e.g. of "ezpointer_parity". Written once per process.
const GateNetlist& script_netlist(const std::string& name);

}  // namespace dtof
