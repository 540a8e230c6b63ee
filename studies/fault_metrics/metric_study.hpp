// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fault_metrics/fault_strata.hpp"
#include "fault_metrics/lane_frame.hpp"

namespace dtof {

/// Faults of a stratum by what they did. A harmful fault is counted once: for the first of parity, protocol,
/// frame check and self-test that detects it, or as undetected.
struct FaultCounts {
  std::uint64_t faults = 0;
  std::uint64_t harmful = 0;
  std::uint64_t beyond = 0;  ///< harmful faults that moved a pixel by more than 3 %, or lost a pixel
  std::uint64_t by_parity = 0;
  std::uint64_t by_protocol = 0;
  std::uint64_t by_frame_check = 0;
  std::uint64_t by_self_test = 0;
  std::uint64_t undetected = 0;
  std::uint64_t undetected_beyond = 0;
  std::uint64_t latent = 0;  ///< harmless, found by no self-test, and hides another fault that parity detects

  bool operator==(const FaultCounts&) const = default;
};

/// Adds a fault. `self_test`: outcome of the self-test's frame, for a fault that is still there; else
/// nullptr.
void count_fault(FaultCounts& counts, const FrameOutcome& frame, const FrameOutcome* self_test);

/// True if a fault that is always there is neither harmful nor found.
bool stays_unseen(const FrameOutcome& frame, const FrameOutcome& self_test);

struct StratumResult {
  CircuitPart part = CircuitPart::kControl;
  Element element = Element::kGate;
  Repeated repeated = Repeated::kArray;
  std::uint64_t sites = 0;
  double full_sites = 0;
  FaultCounts events;  ///< of one clock
  FaultCounts stuck;

  bool operator==(const StratumResult&) const = default;
};

struct ArrayResult {
  std::string readout;
  bool parity = false;
  int rows = 0;
  int columns = 0;
  std::uint64_t clocks = 0;  ///< of the frame without a fault
  std::vector<StratumResult> strata;

  bool operator==(const ArrayResult&) const = default;
};

struct MetricStudyOptions {
  std::uint32_t acquisitions = 3333;
  int faults = 800;  ///< at most, of each stratum and kind
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all processors
};

/// Frames that a small array receives: part of the scene `room`, and the self-test's lines.
struct StudyInputs {
  FrameInput room;
  FrameInput self_test;
};

/// Throws InputError unless `acquisitions` is 2 to 65,535.
StudyInputs study_inputs(const GateNetlist& netlist, std::uint32_t acquisitions, std::uint64_t seed);

/// Damages the netlist. Throws InputError if the netlist without a fault differs from its model.
ArrayResult study_netlist(const GateNetlist& netlist, const MetricStudyOptions& options);

}  // namespace dtof
