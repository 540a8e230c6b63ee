// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fault_metrics/gate_netlist.hpp"
#include "fault_metrics/lane_memory.hpp"
#include "fault_metrics/lanes.hpp"

namespace dtof {

/// What a fault damages.
enum class SiteKind : std::uint8_t {
  kGate,      ///< output of a gate
  kFlipFlop,  ///< output of a flip-flop
  kReadData,  ///< a data output of a memory
  kBit,       ///< a stored bit of a memory
};

/// A place for a fault.
struct FaultSite {
  SiteKind kind = SiteKind::kGate;
  std::uint32_t index = 0;  ///< of the gate, the flip-flop or the memory
  std::uint32_t bit = 0;    ///< kReadData: number of the data bit; kBit: address * width + number

  bool operator==(const FaultSite&) const = default;
};

enum class FaultAction : std::uint8_t {
  kFlip,  ///< a flip-flop or a stored bit changes its state once; any other output is inverted for one clock
  kStuckLow,   ///< 0 in every clock
  kStuckHigh,  ///< 1 in every clock
};

struct CircuitFault {
  FaultSite site;
  FaultAction action = FaultAction::kFlip;
  std::uint64_t clock = 0;  ///< of kFlip: number of clock edges before it

  bool operator==(const CircuitFault&) const = default;
};

/// Simulates a netlist in all lanes, each with its own faults.
class LaneCircuit {
 public:
  /// `netlist` must outlive the circuit. Flip-flops begin with 0, memories with random contents.
  LaneCircuit(const GateNetlist& netlist, std::uint64_t seed);

  /// Faults must be added before the first clock edge.
  void add(const CircuitFault& fault, std::size_t lane);
  void drive(Net net, const Lanes& value) { values_[net] = value; }
  /// Computes all gates from inputs and state.
  void settle();
  /// A rising clock edge. Outputs are valid after the next settle().
  void clock();
  [[nodiscard]] const Lanes& value(Net net) const { return values_[net]; }

 private:
  /// A change of a value: (value & ~low | high) ^ flipped.
  struct Change {
    std::uint32_t index = 0;  ///< of a gate, or a net
    Lanes low, high, flipped;
  };
  struct Flip {
    std::uint64_t clock = 0;
    FaultSite site;
    std::size_t lane = 0;
  };
  struct Run {
    GateKind kind;
    std::uint32_t first, last;
  };

  static void apply(const Change& change, Lanes& value);
  static void merge(std::vector<Change>& changes, std::uint32_t index, FaultAction action, std::size_t lane);
  [[nodiscard]] std::vector<Change> gate_changes();
  void compute(std::uint32_t first, std::uint32_t last);
  void compute_run(GateKind kind, std::uint32_t first, std::uint32_t last);
  void show_memories();
  void flip_state();

  const GateNetlist& netlist_;
  std::vector<Lanes> values_;
  std::vector<Lanes> next_;
  std::vector<LaneMemory> memories_;
  std::vector<Run> runs_;
  std::vector<Change> stuck_gates_;
  std::vector<Change> stuck_nets_;
  std::vector<Flip> flips_;
  std::size_t next_flip_ = 0;
  std::vector<Flip> present_;  // inversions of this clock
  std::uint64_t edges_ = 0;
  bool started_ = false;
};

}  // namespace dtof
