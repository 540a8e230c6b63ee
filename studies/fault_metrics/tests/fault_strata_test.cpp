// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/fault_strata.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace dtof {
namespace {

/// A column with a gate, two flip-flops and a memory of 5 words of 3 bits, the highest one the parity.
GateNetlist column() {
  GateNetlist netlist;
  netlist.readout = "ezpointer";
  netlist.rows = 5;
  netlist.columns = 1;
  netlist.gates.push_back({.part = CircuitPart::kColumns, .repeated = Repeated::kColumn});
  netlist.flip_flops.resize(2);
  Memory memory;
  memory.depth = 5;
  memory.parity_bits = 1;
  memory.read_data = {2, 3, 4};
  netlist.memories.push_back(memory);
  return netlist;
}

TEST(FaultStrata, HaveEveryElementOnce) {
  const std::vector<FaultStratum> strata = fault_strata(column());
  ASSERT_EQ(strata.size(), 5U);
  const auto expect = [&](std::size_t i, CircuitPart part, Element element, std::size_t sites, double full) {
    EXPECT_EQ(strata[i].part, part);
    EXPECT_EQ(strata[i].element, element);
    EXPECT_EQ(strata[i].sites.size(), sites);
    EXPECT_DOUBLE_EQ(strata[i].full_sites, full);
  };
  expect(0, CircuitPart::kColumns, Element::kGate, 1, 200);
  expect(1, CircuitPart::kMemoryControl, Element::kGate, 3, 600);
  expect(2, CircuitPart::kControl, Element::kFlipFlop, 2, 2);
  expect(3, CircuitPart::kWords, Element::kBit, 10, 2.0 * 160 * 200);
  expect(4, CircuitPart::kParityBits, Element::kBit, 5, 160 * 200);
  for (const FaultSite& site : strata[4].sites) {
    EXPECT_EQ(site.bit % 3, 2U);
  }
}

TEST(FaultStrata, AnEngineOccursSixTimes) {
  GateNetlist netlist = column();
  netlist.readout = "poolpointer";
  netlist.gates.front() = {.part = CircuitPart::kEngines, .repeated = Repeated::kEngine};
  const std::vector<FaultStratum> strata = fault_strata(netlist);
  const auto engine = std::ranges::find(strata, CircuitPart::kEngines, &FaultStratum::part);
  ASSERT_NE(engine, strata.end());
  EXPECT_DOUBLE_EQ(engine->full_sites, 6);
}

TEST(FaultStrata, EventsAreOfTheStratumAndRepeatable) {
  const FaultStratum words = fault_strata(column())[3];
  const std::vector<CircuitFault> events = draw_events(words, 300, 50, 1);
  EXPECT_EQ(events, draw_events(words, 300, 50, 1));
  EXPECT_NE(events, draw_events(words, 300, 50, 2));
  for (const CircuitFault& event : events) {
    EXPECT_NE(std::ranges::find(words.sites, event.site), words.sites.end());
    EXPECT_TRUE(event.clock >= 1 && event.clock < 50);
    EXPECT_EQ(event.action, FaultAction::kFlip);
  }
}

TEST(FaultStrata, StuckFaultsAreAllOrNoneTwice) {
  const FaultStratum words = fault_strata(column())[3];
  EXPECT_EQ(draw_stuck(words, 300, 1).size(), 20U);
  std::vector<CircuitFault> some = draw_stuck(words, 15, 1);
  EXPECT_EQ(some.size(), 15U);
  EXPECT_NE(some, draw_stuck(words, 15, 2));
  const auto key = [](const CircuitFault& fault) { return std::tuple(fault.site.bit, fault.action); };
  std::ranges::sort(some, {}, key);
  EXPECT_EQ(std::ranges::adjacent_find(some), some.end());
}

}  // namespace
}  // namespace dtof
