// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/tests/fake_array.hpp"

namespace dtof {
namespace {

constexpr std::size_t kBits = 10;
constexpr std::size_t kConfidenceBits = 4;

}  // namespace

Net FakeArray::add_gate(GateKind kind, Net a, Net b, Net select) {
  const Net y = netlist.nets++;
  netlist.gates.push_back({.kind = kind, .a = a, .b = b, .select = select, .y = y});
  return y;
}

std::uint32_t FakeArray::add_flip_flop(Net d, Net enable) {
  FlipFlop flip_flop{.d = d, .q = netlist.nets++, .enable = enable};
  flip_flop.reset = netlist.port("rst_ni")[0];
  flip_flop.reset_high = false;
  netlist.flip_flops.push_back(flip_flop);
  return static_cast<std::uint32_t>(netlist.flip_flops.size() - 1);
}

Net FakeArray::add_input(const char* name, std::size_t bits) {
  const Net first = netlist.nets;
  for (std::size_t i = 0; i < bits; ++i) {
    netlist.ports[name].push_back(netlist.nets++);
  }
  return first;
}

FakeArray::FakeArray() {
  netlist.readout = "ezpointer";
  netlist.rows = netlist.columns = 1;
  netlist.parity = true;
  add_input("rst_ni");
  const Net start = add_input("start_i");
  add_input("acq_num_i", 16);
  const Net line_valid = add_input("tdc_valid_i");
  add_input("result_tready_i");
  const Net line = add_input("tdc_timestamp_i", kBits);

  // Lines: from the clock after start to the first clock without a line.
  busy = add_flip_flop();
  ready = add_flip_flop();
  const Net take = add_gate(GateKind::kAnd, q(ready), line_valid);
  netlist.flip_flops[ready].d = add_gate(GateKind::kOr, start, take);
  const Net no_line = add_gate(GateKind::kNot, line_valid);
  valid = add_flip_flop(add_gate(GateKind::kAnd, q(ready), no_line));
  done = add_flip_flop(q(valid));
  const Net not_done = add_gate(GateKind::kNot, q(done));
  netlist.flip_flops[busy].d = add_gate(GateKind::kOr, start, add_gate(GateKind::kAnd, q(busy), not_done));

  Net stored = kLow;
  Net shown = kLow;
  std::vector<Net> word(kConfidenceBits, kLow);
  for (std::size_t i = 0; i < kBits; ++i) {
    const Net timestamp = line + static_cast<Net>(i);
    const std::uint32_t bit = add_flip_flop(kLow, take);
    netlist.flip_flops[bit].d = add_gate(GateKind::kXor, q(bit), timestamp);
    data = i == 0 ? bit : data;
    word.push_back(q(bit));
    stored = add_gate(GateKind::kXor, stored, timestamp);
    shown = add_gate(GateKind::kXor, shown, q(bit));
  }
  parity = add_flip_flop(kLow, take);
  netlist.flip_flops[parity].d = add_gate(GateKind::kXor, q(parity), stored);
  column = add_flip_flop(kLow, kLow);
  error = add_flip_flop();
  word.push_back(kLow);  // row
  word.push_back(q(column));
  const Net differs = add_gate(GateKind::kXor, shown, q(parity));
  netlist.ports["parity_error_o"] = {add_gate(GateKind::kAnd, differs, q(valid))};
  netlist.ports["error_o"] = {q(error)};
  netlist.ports["busy_o"] = {q(busy)};
  netlist.ports["done_o"] = {q(done)};
  netlist.ports["tdc_ready_o"] = {q(ready)};
  netlist.ports["result_tvalid_o"] = {q(valid)};
  netlist.ports["result_tlast_o"] = {q(valid)};
  netlist.ports["result_tdata_o"] = word;
}

FrameInput fake_frame(Timestamp result) {
  constexpr Timestamp kFirst = 100;
  constexpr Timestamp kSecond = 7;
  FrameInput input;
  input.acquisitions = 3;
  input.lines = {{kFirst}, {kSecond}, {static_cast<Timestamp>(result ^ kFirst ^ kSecond)}};
  return input;
}

}  // namespace dtof
