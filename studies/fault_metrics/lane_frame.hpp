// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/result.hpp"
#include "fault_metrics/gate_netlist.hpp"
#include "fault_metrics/lane_circuit.hpp"
#include "rtl/configuration.hpp"

namespace dtof {

/// What an array receives in a frame.
struct FrameInput {
  std::uint32_t acquisitions = 0;
  std::vector<std::vector<Timestamp>> lines;  ///< timestamps of all columns, in the order of the TDC stream
};

/// Lines of streams, one per column.
FrameInput frame_input(const RtlConfiguration& configuration, std::span<const ColumnStream> columns,
                       std::uint32_t acquisitions);

/// The array of a netlist, as the models describe it. Throws InputError if the read-out is unknown.
RtlConfiguration netlist_configuration(const GateNetlist& netlist);

/// What the array without a fault gives in a frame.
struct FrameReference {
  std::vector<std::uint64_t> results;  ///< words of the result stream, in their order
  std::uint64_t clocks = 0;            ///< from start to done
};

/// What a faulty array did in a frame, compared with the array without a fault.
struct FrameOutcome {
  bool wrong_result = false;  ///< a word of the result stream differs
  bool beyond = false;        ///< a result is missing, or a position differs by more than 3 % of the position
  bool wrong_count = false;   ///< too few or too many results, or the wrong one is marked as the last
  bool wrong_order = false;   ///< a result has another row or column than it should
  bool endless = false;  ///< no done within an eighth more than the clocks of the frame, or busy afterwards
  bool parity_error = false;    ///< parity_error_o was high
  bool protocol_error = false;  ///< a bit of error_o was high

  /// Wrong or missing results, or no end.
  [[nodiscard]] bool harmful() const { return wrong_result || wrong_count || endless; }
  /// Something that a receiver observes in this frame: results that are missing or have no place, no end.
  [[nodiscard]] bool frame_check() const { return wrong_count || wrong_order || endless; }
  [[nodiscard]] bool detected() const { return parity_error || protocol_error || frame_check(); }

  bool operator==(const FrameOutcome&) const = default;
};

/// A fault in a lane. A lane may have several faults.
struct LaneFault {
  std::size_t lane = 0;
  CircuitFault fault;
};

/// Lanes for faults: lane 0 has none, and lanes kFirstFaultyLane .. kLanes - 1 may have some.
inline constexpr std::size_t kFirstFaultyLane = 1;
inline constexpr std::size_t kFaultyLanes = kLanes - kFirstFaultyLane;

/// Runs the array without a fault. Throws InputError if the frame does not end, or if parity_error_o or
/// error_o is ever high.
FrameReference run_reference(const GateNetlist& netlist, const FrameInput& input, std::uint64_t seed);

/// Runs a reset and a frame in all lanes. Returns an outcome per lane. Throws InputError if lane 0, which has
/// no fault, differs from the reference.
std::vector<FrameOutcome> run_lanes(const GateNetlist& netlist, const FrameInput& input,
                                    const FrameReference& reference, std::span<const LaneFault> faults,
                                    std::uint64_t seed);

/// Results of the reference, index = row * columns + column. Throws InputError for a word of no pixel.
std::vector<PixelResult> reference_results(const GateNetlist& netlist, const FrameReference& reference);

}  // namespace dtof
