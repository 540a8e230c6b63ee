// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fault_metrics/circuit_part.hpp"
#include "fault_metrics/gate_netlist.hpp"
#include "fault_metrics/lane_circuit.hpp"

namespace dtof {

enum class Element : std::uint8_t { kGate, kFlipFlop, kBit };

/// E.g. "flip-flops".
std::string_view element_title(Element element);

/// The array for which shares are weighted: that of the thesis.
inline constexpr int kFullColumns = 200;
inline constexpr int kFullRows = 160;

/// Elements of one kind in one part of an array, all places for faults. Faults are drawn from each stratum.
struct FaultStratum {
  CircuitPart part = CircuitPart::kControl;
  Element element = Element::kGate;
  Repeated repeated = Repeated::kArray;
  std::vector<FaultSite> sites;
  double full_sites = 0;  ///< in an array of kFullColumns x kFullRows pixels
};

/// All elements of a netlist. Data outputs of a memory count as gates of the memory control.
std::vector<FaultStratum> fault_strata(const GateNetlist& netlist);

/// `most` faults of one clock: a random element in a random clock 1 .. clocks - 1, with replacement.
std::vector<CircuitFault> draw_events(const FaultStratum& stratum, int most, std::uint64_t clocks,
                                      std::uint64_t seed);

/// Stuck-at faults of the stratum: all of them if they are at most `most`, else `most` of them, none twice.
std::vector<CircuitFault> draw_stuck(const FaultStratum& stratum, int most, std::uint64_t seed);

}  // namespace dtof
