// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fault_metrics/gate_netlist.hpp"
#include "fault_metrics/lane_frame.hpp"

namespace dtof {

/// An array of one pixel, drawn by hand: the pixel's result is the XOR of its timestamps, whose parity is
/// stored and checked. With the ports of dtof_array. Clock 0 is that of start; then come a line per clock, a
/// clock without a line, the result, done.
struct FakeArray {
  GateNetlist netlist;
  // Indices of flip-flops.
  std::uint32_t busy = 0;
  std::uint32_t ready = 0;   ///< on tdc_ready_o
  std::uint32_t data = 0;    ///< the lowest of ten
  std::uint32_t parity = 0;  ///< of the data
  std::uint32_t column = 0;  ///< bit of the result's address
  std::uint32_t valid = 0;   ///< the result is on the port
  std::uint32_t done = 0;
  std::uint32_t error = 0;  ///< on error_o

  FakeArray();

 private:
  Net add_gate(GateKind kind, Net a, Net b = kLow, Net select = kLow);
  /// A flip-flop with a reset; its input is `d`, or is connected later.
  std::uint32_t add_flip_flop(Net d = kLow, Net enable = kHigh);
  Net q(std::uint32_t flip_flop) const { return netlist.flip_flops[flip_flop].q; }
  Net add_input(const char* name, std::size_t bits = 1);
};

/// A frame of three lines with this result.
FrameInput fake_frame(Timestamp result);

}  // namespace dtof
