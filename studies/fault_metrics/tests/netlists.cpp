// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/tests/netlists.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <stdexcept>

namespace dtof {

bool has_yosys() { return std::system("command -v yosys > /dev/null") == 0; }

const GateNetlist& script_netlist(const std::string& name) {
  static std::map<std::string, GateNetlist> netlists;
  const auto known = netlists.find(name);
  if (known != netlists.end()) {
    return known->second;
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("dtof_fault_netlists_{}", getpid());
  const std::string readout = name.substr(0, name.find('_'));
  const std::string command =
      fmt::format("{}/scripts/fault_netlists.py {} {}", DTOF_ROOT, folder.string(), readout);
  if (std::system(command.c_str()) != 0) {
    throw std::runtime_error(command + " failed");
  }
  for (const std::string& one : {readout, readout + "_parity"}) {
    netlists.emplace(one, read_gate_netlist(folder / (one + ".json")));
  }
  std::filesystem::remove_all(folder);
  return netlists.at(name);
}

}  // namespace dtof
