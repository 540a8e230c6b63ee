// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/gate_netlist.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;

/// A module of Yosys: an AND behind an inverter that comes later, a flip-flop, a memory.
nlohmann::json netlist_json() {
  return nlohmann::json::parse(R"({"modules": {
    "sram": {"attributes": {"blackbox": "1"}, "ports": {}, "cells": {}},
    "$paramod\\dtof_sram_1r1w": {"attributes": {"blackbox": "1"}, "ports": {}, "cells": {},
      "parameter_default_values": {"DEPTH": "00000101", "WIDTH": "00000001"}},
    "array": {
      "attributes": {"top": "1", "dtof_readout": "ezpointer", "dtof_rows": "00010000", "dtof_columns": "00000100",
        "dtof_parity": "00000001"},
      "ports": {"clk_i": {"bits": [2]}, "a_i": {"bits": [3, "1", "0", "x"]}, "q_o": {"bits": [7]}},
      "cells": {
        "and": {"type": "$_AND_", "connections": {"A": [3], "B": [5], "Y": [6]}},
        "not": {"type": "$_NOT_", "connections": {"A": [7], "Y": [5]}},
        "$flatten\\g_column[0].u_column.$1": {"type": "$_DFFE_PN0N_",
          "connections": {"C": [2], "D": [6], "E": [8], "Q": [7], "R": [9]}},
        "$flatten\\g_column[0].u_column.u_word_sram.u_words.u_macro": {"type": "$paramod\\dtof_sram_1r1w",
          "connections": {"clk_i": [2], "cfg_i": [3], "cfg_o": [30], "re_i": [8], "raddr_i": [3, 3, 3],
            "rdata_o": [31], "we_i": [9], "waddr_i": [3, 3, 3], "wdata_i": [30]}}
      }}}})");
}

TEST(GateNetlist, ReadsWhatYosysWrites) {
  const GateNetlist netlist = parse_gate_netlist(netlist_json(), "test.json");
  EXPECT_EQ(netlist.readout, "ezpointer");
  EXPECT_EQ(netlist.rows, 16);
  EXPECT_EQ(netlist.columns, 4);
  EXPECT_TRUE(netlist.parity);
  ASSERT_EQ(netlist.gates.size(), 2U);
  EXPECT_EQ(netlist.gates[0].kind, GateKind::kNot) << "drives the other gate";
  EXPECT_EQ(netlist.gates[1].b, netlist.gates[0].y);
  ASSERT_EQ(netlist.flip_flops.size(), 1U);
  const FlipFlop& flip_flop = netlist.flip_flops.front();
  EXPECT_FALSE(flip_flop.enable_high || flip_flop.reset_high || flip_flop.reset_value);
  EXPECT_EQ(flip_flop.q, netlist.port("q_o")[0]);
  EXPECT_EQ(flip_flop.repeated, Repeated::kColumn);
  const std::vector<Net>& constants = netlist.port("a_i");
  EXPECT_EQ(std::vector<Net>(constants.begin() + 1, constants.end()), (std::vector<Net>{kHigh, kLow, kLow}));
  ASSERT_EQ(netlist.memories.size(), 1U);
  const Memory& memory = netlist.memories.front();
  EXPECT_EQ(memory.depth, 5U);
  EXPECT_TRUE(memory.two_ports);
  EXPECT_EQ(memory.parity_bits, 1U);
  EXPECT_EQ(memory.write_data[0], netlist.port("a_i")[0]) << "the side band runs through the memory";
}

/// The error text of a netlist.
std::string refusal(const nlohmann::json& json) {
  try {
    (void)parse_gate_netlist(json, "test.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(GateNetlist, RefusesWhatItCannotSimulate) {
  nlohmann::json json = netlist_json();
  json["modules"]["array"]["cells"]["and"]["type"] = "$_DLATCH_P_";
  EXPECT_THAT(refusal(json), HasSubstr("test.json: cell 'and' has the unknown type '$_DLATCH_P_'"));
  json = netlist_json();
  json["modules"]["array"]["cells"]["not"]["connections"]["A"][0] = 6;
  EXPECT_THAT(refusal(json), HasSubstr("a combinational loop"));
  json = netlist_json();
  json["modules"]["$paramod\\dtof_sram_1r1w"]["parameter_default_values"]["WIDTH"] = "00001000";
  EXPECT_THAT(refusal(json), HasSubstr("has 1 data bits, but its type has 8"));
  json = netlist_json();
  json["modules"]["array"]["attributes"].erase("dtof_rows");
  EXPECT_THAT(refusal(json), HasSubstr("no attribute 'dtof_rows'"));
  json = netlist_json();
  json["modules"]["array"]["attributes"].erase("top");
  EXPECT_THAT(refusal(json), HasSubstr("no module is the top"));
  EXPECT_THAT(refusal(nlohmann::json::object()), HasSubstr("no netlist of Yosys"));
  EXPECT_THROW((void)parse_gate_netlist(netlist_json(), "test.json").port("other"), InputError);
}

}  // namespace
}  // namespace dtof
