// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/gate_netlist.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/json_file.hpp"

namespace dtof {
namespace {

using Json = nlohmann::json;

constexpr std::uint32_t kBinary = 2;

struct NamedKind {
  std::string_view type;
  GateKind kind;
};
constexpr std::array<NamedKind, 9> kGateTypes = {{
    {"$_BUF_", GateKind::kBuffer},
    {"$_NOT_", GateKind::kNot},
    {"$_AND_", GateKind::kAnd},
    {"$_OR_", GateKind::kOr},
    {"$_XOR_", GateKind::kXor},
    {"$_NAND_", GateKind::kNand},
    {"$_NOR_", GateKind::kNor},
    {"$_XNOR_", GateKind::kXnor},
    {"$_MUX_", GateKind::kMux},
}};

/// Turns the members of a module of Yosys into a netlist.
class NetlistReader {
 public:
  NetlistReader(const Json& module, const Json& modules, std::string name)
      : module_(module), modules_(modules), name_(std::move(name)) {}

  GateNetlist read() {
    read_attributes();
    for (const auto& [cell_name, cell] : module_.at("cells").items()) {
      alias_side_band(cell);
    }
    for (const auto& [port, description] : module_.at("ports").items()) {
      netlist_.ports[port] = nets(description.at("bits"));
    }
    for (const auto& [cell_name, cell] : module_.at("cells").items()) {
      read_cell(cell_name, cell);
    }
    sort_gates();
    return std::move(netlist_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(fmt::format("{}: {}", name_, reason));
  }

  [[nodiscard]] std::string attribute(const char* key) const {
    const Json& attributes = module_.at("attributes");
    const auto found = attributes.find(key);
    if (found == attributes.end()) {
      fail(fmt::format("no attribute '{}'; scripts/fault_netlists.py writes netlists that have one", key));
    }
    return found->get<std::string>();
  }

  void read_attributes() {
    netlist_.readout = attribute("dtof_readout");
    const auto number = [this](const char* key) { return std::stoi(attribute(key), nullptr, kBinary); };
    netlist_.rows = number("dtof_rows");
    netlist_.columns = number("dtof_columns");
    netlist_.parity = number("dtof_parity") != 0;
  }

  /// The side band of a memory runs through the memory.
  void alias_side_band(const Json& cell) {
    const Json& pins = cell.at("connections");
    if (!pins.contains("cfg_o")) {
      return;
    }
    const Json& out = pins.at("cfg_o");
    for (std::size_t i = 0; i < out.size(); ++i) {
      ids_[out[i].get<std::uint32_t>()] = net(pins.at("cfg_i")[i]);
    }
  }

  Net net(const Json& bit) {
    if (bit.is_string()) {  // "x" is any value
      return bit.get<std::string>() == "1" ? kHigh : kLow;
    }
    const auto [found, added] = ids_.try_emplace(bit.get<std::uint32_t>(), netlist_.nets);
    netlist_.nets += added ? 1 : 0;
    return found->second;
  }

  std::vector<Net> nets(const Json& bits) {
    std::vector<Net> found;
    for (const Json& bit : bits) {
      found.push_back(net(bit));
    }
    return found;
  }

  void read_cell(const std::string& cell_name, const Json& cell) {
    const auto type = cell.at("type").get<std::string>();
    const Json& pins = cell.at("connections");
    const auto* gate = std::ranges::find(kGateTypes, type, &NamedKind::type);
    if (gate != kGateTypes.end()) {
      read_gate(gate->kind, cell_name, pins);
    } else if (type.find("dtof_sram_1r") != std::string::npos) {
      read_memory(cell_name, type, pins);
    } else if (!read_flip_flop(type, cell_name, pins)) {
      fail(fmt::format("cell '{}' has the unknown type '{}'", cell_name, type));
    }
  }

  void read_gate(GateKind kind, const std::string& cell_name, const Json& pins) {
    const auto pin = [&](const char* name) { return pins.contains(name) ? net(pins.at(name)[0]) : kLow; };
    netlist_.gates.push_back({.kind = kind,
                              .part = part_of_cell(cell_name),
                              .repeated = repeated_of_cell(cell_name),
                              .a = pin("A"),
                              .b = pin("B"),
                              .select = pin("S"),
                              .y = pin("Y")});
  }

  /// `$_DFF_P_`, `$_DFFE_PN_`, `$_DFF_PN0_`, `$_DFFE_PN0P_`, `$_SDFF_PP0_`, `$_SDFFE_PP0P_`,
  /// `$_SDFFCE_PP0P_`: polarities of clock, reset with its value, enable.
  bool read_flip_flop(const std::string& type, const std::string& cell_name, const Json& pins) {
    const std::size_t end = type.rfind('_', type.size() - 2);
    if (!type.starts_with("$_") || end == std::string::npos || end < 2) {
      return false;
    }
    const std::string family = type.substr(2, end - 2);
    std::string code = type.substr(end + 1, type.size() - end - 2);
    const bool synchronous = family == "SDFF" || family == "SDFFE" || family == "SDFFCE";
    const bool has_enable = family.ends_with("E");
    if ((!synchronous && family != "DFF" && family != "DFFE") || !code.starts_with("P")) {
      return false;
    }
    const bool has_reset = code.size() >= 3;
    FlipFlop flip_flop{.part = part_of_cell(cell_name),
                       .repeated = repeated_of_cell(cell_name),
                       .d = net(pins.at("D")[0]),
                       .q = net(pins.at("Q")[0])};
    if (has_reset) {
      flip_flop.reset = net(pins.at("R")[0]);
      flip_flop.reset_high = code[1] == 'P';
      flip_flop.reset_value = code[2] == '1';
    }
    if (has_enable) {
      flip_flop.enable = net(pins.at("E")[0]);
      flip_flop.enable_high = code.back() == 'P';
      flip_flop.reset_needs_enable = family == "SDFFCE";
    }
    netlist_.flip_flops.push_back(flip_flop);
    return true;
  }

  void read_memory(const std::string& cell_name, const std::string& type, const Json& pins) {
    Memory memory;
    memory.path = cell_name;
    memory.repeated = repeated_of_cell(cell_name);
    memory.two_ports = type.find("dtof_sram_1r1w") != std::string::npos;
    const Json& parameters = modules_.at(type).at("parameter_default_values");
    const auto parameter = [&](const char* key) {
      return static_cast<std::uint32_t>(std::stoul(parameters.at(key).get<std::string>(), nullptr, kBinary));
    };
    memory.depth = parameter("DEPTH");
    memory.read_enable = net(pins.at(memory.two_ports ? "re_i" : "en_i")[0]);
    memory.write_enable = net(pins.at("we_i")[0]);
    memory.read_address = nets(pins.at(memory.two_ports ? "raddr_i" : "addr_i"));
    memory.write_address = nets(pins.at(memory.two_ports ? "waddr_i" : "addr_i"));
    memory.read_data = nets(pins.at("rdata_o"));
    memory.write_data = nets(pins.at("wdata_i"));
    if (!memory.two_ports) {
      memory.write_parts = nets(pins.at("wparts_i"));
    }
    if (memory.width() != parameter("WIDTH")) {
      fail(fmt::format("memory '{}' has {} data bits, but its type has {}", cell_name, memory.width(),
                       parameter("WIDTH")));
    }
    memory.parity_bits = netlist_.parity ? parity_bits_of_memory(cell_name, memory.width()) : 0;
    netlist_.memories.push_back(std::move(memory));
  }

  /// Level by level: a gate is one level above the highest gate that drives one of its inputs.
  void sort_gates() {
    std::vector<Gate>& gates = netlist_.gates;
    std::vector<std::optional<std::size_t>> driver(netlist_.nets);
    for (std::size_t i = 0; i < gates.size(); ++i) {
      driver[gates[i].y] = i;
    }
    std::vector<std::vector<std::size_t>> readers(gates.size());
    std::vector<std::size_t> missing(gates.size(), 0);
    for (std::size_t i = 0; i < gates.size(); ++i) {
      for (const Net input : {gates[i].a, gates[i].b, gates[i].select}) {
        if (driver[input]) {
          readers[*driver[input]].push_back(i);
          ++missing[i];
        }
      }
    }
    std::vector<std::size_t> level;
    for (std::size_t i = 0; i < gates.size(); ++i) {
      if (missing[i] == 0) {
        level.push_back(i);
      }
    }
    std::vector<Gate> sorted;
    while (!level.empty()) {
      std::ranges::sort(level, {}, [&](std::size_t i) { return std::tuple(gates[i].kind, i); });
      std::vector<std::size_t> next;
      for (const std::size_t i : level) {
        sorted.push_back(gates[i]);
        for (const std::size_t reader : readers[i]) {
          if (--missing[reader] == 0) {
            next.push_back(reader);
          }
        }
      }
      level = std::move(next);
    }
    if (sorted.size() != gates.size()) {
      fail("a combinational loop");
    }
    gates = std::move(sorted);
  }

  const Json& module_;
  const Json& modules_;
  std::string name_;
  GateNetlist netlist_;
  std::map<std::uint32_t, Net> ids_;
};

}  // namespace

const std::vector<Net>& GateNetlist::port(const std::string& name) const {
  const auto found = ports.find(name);
  if (found == ports.end()) {
    throw InputError(fmt::format("the netlist of {} has no port '{}'", readout, name));
  }
  return found->second;
}

GateNetlist parse_gate_netlist(const nlohmann::json& json, const std::string& name) {
  try {
    const Json& modules = json.at("modules");
    for (const auto& [module_name, module] : modules.items()) {
      if (module.at("attributes").contains("top")) {
        return NetlistReader(module, modules, name).read();
      }
    }
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: no netlist of Yosys ({})", name, error.what()));
  }
  throw InputError(fmt::format("{}: no module is the top", name));
}

GateNetlist read_gate_netlist(const std::filesystem::path& path) {
  return parse_gate_netlist(read_json(path), path.string());
}

}  // namespace dtof
