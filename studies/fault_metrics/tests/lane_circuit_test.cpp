// SPDX-License-Identifier: Apache-2.0
// Faults of a counter of one bit and an inverter behind it.
#include "fault_metrics/lane_circuit.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace dtof {
namespace {

constexpr Net kState = 2;
constexpr Net kInverse = 3;

GateNetlist toggle() {
  GateNetlist netlist;
  netlist.nets = 4;
  netlist.gates.push_back({.kind = GateKind::kNot, .a = kState, .y = kInverse});
  netlist.flip_flops.push_back({.d = kInverse, .q = kState});
  return netlist;
}

/// Values of a net in lane 9, clock by clock.
std::string watch(const CircuitFault& fault, Net net) {
  const GateNetlist netlist = toggle();
  LaneCircuit circuit(netlist, 1);
  constexpr std::size_t kLane = 9;
  circuit.add(fault, kLane);
  std::string values;
  for (int clock = 0; clock < 6; ++clock) {
    circuit.settle();
    values += circuit.value(net).get(kLane) ? '1' : '0';
    EXPECT_EQ(circuit.value(kState).get(kLane + 1), clock % 2 != 0) << "a lane without a fault";
    circuit.clock();
  }
  return values;
}

constexpr FaultSite kGateSite{SiteKind::kGate, 0, 0};
constexpr FaultSite kFlipFlopSite{SiteKind::kFlipFlop, 0, 0};

TEST(LaneCircuit, AFlippedFlipFlopKeepsItsNewState) {
  EXPECT_EQ(watch({kFlipFlopSite, FaultAction::kFlip, 2}, kState), "011010");
}

TEST(LaneCircuit, AnInvertedGateIsInvertedForOneClock) {
  EXPECT_EQ(watch({kGateSite, FaultAction::kFlip, 2}, kInverse), "100101");
}

// In one clock only, the state would toggle before and after.
TEST(LaneCircuit, AStuckElementIsStuckInEveryClock) {
  EXPECT_EQ(watch({kFlipFlopSite, FaultAction::kStuckHigh, 0}, kState), "111111");
  EXPECT_EQ(watch({kFlipFlopSite, FaultAction::kStuckLow, 0}, kState), "000000");
  EXPECT_EQ(watch({kGateSite, FaultAction::kStuckHigh, 0}, kInverse), "111111");
  EXPECT_EQ(watch({kGateSite, FaultAction::kStuckHigh, 0}, kState), "011111");
}

TEST(LaneCircuit, RefusesAFaultAfterTheFirstClock) {
  const GateNetlist netlist = toggle();
  LaneCircuit circuit(netlist, 1);
  circuit.settle();
  circuit.clock();
  EXPECT_THROW(circuit.add({kGateSite, FaultAction::kFlip, 2}, 1), std::logic_error);
}

TEST(LaneCircuit, EveryGateAndFlipFlop) {
  GateNetlist netlist;
  constexpr Net kA = 2;
  constexpr Net kB = 3;
  constexpr Net kSelect = 4;
  netlist.nets = 5;
  for (const GateKind kind :
       {GateKind::kBuffer, GateKind::kNot, GateKind::kAnd, GateKind::kOr, GateKind::kXor, GateKind::kNand,
        GateKind::kNor, GateKind::kXnor, GateKind::kMux}) {
    netlist.gates.push_back({.kind = kind, .a = kA, .b = kB, .select = kSelect, .y = netlist.nets++});
  }
  // Reset to 1 by a low level that needs the enable, and a low enable.
  FlipFlop flip_flop{.d = kA, .q = netlist.nets++, .enable = kB, .reset = kSelect};
  flip_flop.enable_high = flip_flop.reset_high = false;
  flip_flop.reset_value = flip_flop.reset_needs_enable = true;
  netlist.flip_flops.push_back(flip_flop);
  LaneCircuit circuit(netlist, 1);
  const auto drive = [&](Net net, unsigned bit) {  // lane i has the bits of i
    Lanes lanes;
    for (std::size_t lane = 0; lane < 8; ++lane) {
      lanes.set(lane, (lane >> bit & 1U) != 0);
    }
    circuit.drive(net, lanes);
  };
  drive(kA, 0);
  drive(kB, 1);
  drive(kSelect, 2);
  circuit.settle();
  const auto values = [&](Net net) { return circuit.value(net).words[0] & 0xFFU; };
  const std::vector<std::uint64_t> expected = {0xAA, 0x55, 0x88, 0xEE, 0x66, 0x77, 0x11, 0x99, 0xCA};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(values(netlist.gates[i].y), expected[i]) << "gate " << i;
  }
  circuit.clock();
  EXPECT_EQ(values(flip_flop.q), 0x33U & (0x0FU | 0xAAU));
}

}  // namespace
}  // namespace dtof
