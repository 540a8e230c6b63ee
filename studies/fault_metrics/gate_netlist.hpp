// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fault_metrics/circuit_part.hpp"

namespace dtof {

/// Index of a net of a netlist.
using Net = std::uint32_t;
inline constexpr Net kLow = 0;   ///< the net that is always 0
inline constexpr Net kHigh = 1;  ///< the net that is always 1

enum class GateKind : std::uint8_t { kBuffer, kNot, kAnd, kOr, kXor, kNand, kNor, kXnor, kMux };

struct Gate {
  GateKind kind = GateKind::kBuffer;
  CircuitPart part = CircuitPart::kControl;
  Repeated repeated = Repeated::kArray;
  Net a = kLow;
  Net b = kLow;       ///< of kMux: the value if `select` is 1
  Net select = kLow;  ///< of kMux only
  Net y = kLow;
};

struct FlipFlop {
  CircuitPart part = CircuitPart::kControl;
  Repeated repeated = Repeated::kArray;
  Net d = kLow;
  Net q = kLow;
  Net enable = kHigh;
  Net reset = kLow;
  bool enable_high = true;
  bool reset_high = true;
  bool reset_value = false;
  bool reset_needs_enable = false;
};

/// A memory macro. With one port, `read_enable` is the enable of the port, and both addresses are the same.
struct Memory {
  std::string path;
  Repeated repeated = Repeated::kColumn;
  bool two_ports = true;
  std::uint32_t parity_bits = 0;  ///< the highest bits of a word that are parities
  std::uint32_t depth = 0;
  Net read_enable = kLow;
  Net write_enable = kLow;
  std::vector<Net> read_address;
  std::vector<Net> write_address;
  std::vector<Net> read_data;
  std::vector<Net> write_parts;  ///< enables of equal parts of the word, with `write_enable`; empty: all
  std::vector<Net> write_data;

  [[nodiscard]] std::uint32_t width() const { return static_cast<std::uint32_t>(read_data.size()); }
};

/// An array as gates, flip-flops and memories with one clock. Gates are sorted: each one follows those that
/// drive its inputs; gates of one kind that do not depend on each other are neighbours.
struct GateNetlist {
  std::string readout;  ///< name of the read-out, as `dtof list` shows it
  int rows = 0;
  int columns = 0;
  bool parity = false;
  std::uint32_t nets = 2;
  std::vector<Gate> gates;
  std::vector<FlipFlop> flip_flops;
  std::vector<Memory> memories;
  std::map<std::string, std::vector<Net>> ports;  ///< lowest bit first

  /// Nets of a port. Throws InputError if the netlist has no such port.
  [[nodiscard]] const std::vector<Net>& port(const std::string& name) const;
};

/// Reads a netlist that scripts/fault_netlists.py wrote. Throws InputError "<path>: <reason>" for a cell of
/// an unknown type, for a combinational loop and for a missing attribute.
GateNetlist read_gate_netlist(const std::filesystem::path& path);

/// As read_gate_netlist; `name` is the file's name in error texts.
GateNetlist parse_gate_netlist(const nlohmann::json& json, const std::string& name);

}  // namespace dtof
