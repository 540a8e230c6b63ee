// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/lane_circuit.hpp"

#include <algorithm>
#include <stdexcept>

namespace dtof {

LaneCircuit::LaneCircuit(const GateNetlist& netlist, std::uint64_t seed)
    : netlist_(netlist), values_(netlist.nets), next_(netlist.flip_flops.size()) {
  values_[kHigh] = Lanes::all(true);
  memories_.reserve(netlist.memories.size());
  for (const Memory& memory : netlist.memories) {
    memories_.emplace_back(memory, seed + memories_.size());
  }
  const auto count = static_cast<std::uint32_t>(netlist.gates.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (runs_.empty() || runs_.back().kind != netlist.gates[i].kind) {
      runs_.push_back({netlist.gates[i].kind, i, i});
    }
    runs_.back().last = i + 1;
  }
}

void LaneCircuit::merge(std::vector<Change>& changes, std::uint32_t index, FaultAction action,
                        std::size_t lane) {
  auto place = std::ranges::lower_bound(changes, index, {}, &Change::index);
  if (place == changes.end() || place->index != index) {
    place = changes.insert(place, Change{.index = index, .low = {}, .high = {}, .flipped = {}});
  }
  Lanes& mask = action == FaultAction::kFlip       ? place->flipped
                : action == FaultAction::kStuckLow ? place->low
                                                   : place->high;
  mask.set(lane, true);
}

void LaneCircuit::apply(const Change& change, Lanes& value) {
  value = ((value & ~change.low) | change.high) ^ change.flipped;
}

void LaneCircuit::add(const CircuitFault& fault, std::size_t lane) {
  if (edges_ != 0) {
    throw std::logic_error("a fault after the first clock edge");
  }
  const FaultSite& site = fault.site;
  if (fault.action == FaultAction::kFlip) {
    flips_.push_back({fault.clock, site, lane});
    return;
  }
  switch (site.kind) {
    case SiteKind::kGate:
      merge(stuck_gates_, site.index, fault.action, lane);
      break;
    case SiteKind::kFlipFlop:
      merge(stuck_nets_, netlist_.flip_flops[site.index].q, fault.action, lane);
      break;
    case SiteKind::kReadData:
      merge(stuck_nets_, netlist_.memories[site.index].read_data[site.bit], fault.action, lane);
      break;
    case SiteKind::kBit:
      memories_[site.index].stick(site.bit, lane, fault.action == FaultAction::kStuckHigh);
      break;
  }
}

void LaneCircuit::flip_state() {
  if (!started_) {
    started_ = true;
    std::ranges::stable_sort(flips_, {}, &Flip::clock);
  }
  present_.clear();
  for (; next_flip_ < flips_.size() && flips_[next_flip_].clock == edges_; ++next_flip_) {
    const Flip& flip = flips_[next_flip_];
    if (flip.site.kind == SiteKind::kFlipFlop) {
      Lanes& value = values_[netlist_.flip_flops[flip.site.index].q];
      value = value ^ Lanes::one(flip.lane);
    } else if (flip.site.kind == SiteKind::kBit) {
      memories_[flip.site.index].flip(flip.site.bit, flip.lane);
    } else {
      present_.push_back(flip);
    }
  }
}

void LaneCircuit::show_memories() {
  for (std::size_t i = 0; i < memories_.size(); ++i) {
    const std::vector<Net>& nets = netlist_.memories[i].read_data;
    for (std::size_t bit = 0; bit < nets.size(); ++bit) {
      values_[nets[bit]] = memories_[i].read_data()[bit];
    }
  }
  for (const Flip& flip : present_) {
    if (flip.site.kind == SiteKind::kReadData) {
      Lanes& value = values_[netlist_.memories[flip.site.index].read_data[flip.site.bit]];
      value = value ^ Lanes::one(flip.lane);
    }
  }
}

std::vector<LaneCircuit::Change> LaneCircuit::gate_changes() {
  std::vector<Change> changes = stuck_gates_;
  for (const Flip& flip : present_) {
    if (flip.site.kind == SiteKind::kGate) {
      merge(changes, flip.site.index, FaultAction::kFlip, flip.lane);
    }
  }
  return changes;
}

void LaneCircuit::settle() {
  flip_state();
  show_memories();
  for (const Change& change : stuck_nets_) {
    apply(change, values_[change.index]);
  }
  const auto count = static_cast<std::uint32_t>(netlist_.gates.size());
  const bool inverted =
      std::ranges::any_of(present_, [](const Flip& flip) { return flip.site.kind == SiteKind::kGate; });
  const std::vector<Change> with_inverted = inverted ? gate_changes() : std::vector<Change>();
  const std::vector<Change>& changes = inverted ? with_inverted : stuck_gates_;
  std::uint32_t done = 0;
  for (const Change& change : changes) {
    compute(done, change.index + 1);
    apply(change, values_[netlist_.gates[change.index].y]);
    done = change.index + 1;
  }
  compute(done, count);
}

void LaneCircuit::compute(std::uint32_t first, std::uint32_t last) {
  if (first >= last) {
    return;
  }
  auto run = std::ranges::upper_bound(runs_, first, {}, &Run::last);
  for (; run != runs_.end() && run->first < last; ++run) {
    compute_run(run->kind, std::max(first, run->first), std::min(last, run->last));
  }
}

void LaneCircuit::compute_run(GateKind kind, std::uint32_t first, std::uint32_t last) {
  const auto each = [&](const auto& function) {
    for (std::uint32_t i = first; i < last; ++i) {
      const Gate& gate = netlist_.gates[i];
      values_[gate.y] = function(values_[gate.a], values_[gate.b], gate);
    }
  };
  using Value = const Lanes&;
  switch (kind) {
    case GateKind::kBuffer:
      return each([](Value a, Value, const Gate&) { return a; });
    case GateKind::kNot:
      return each([](Value a, Value, const Gate&) { return ~a; });
    case GateKind::kAnd:
      return each([](Value a, Value b, const Gate&) { return a & b; });
    case GateKind::kOr:
      return each([](Value a, Value b, const Gate&) { return a | b; });
    case GateKind::kXor:
      return each([](Value a, Value b, const Gate&) { return a ^ b; });
    case GateKind::kNand:
      return each([](Value a, Value b, const Gate&) { return ~(a & b); });
    case GateKind::kNor:
      return each([](Value a, Value b, const Gate&) { return ~(a | b); });
    case GateKind::kXnor:
      return each([](Value a, Value b, const Gate&) { return ~(a ^ b); });
    case GateKind::kMux:
      return each([this](Value a, Value b, const Gate& gate) { return choose(values_[gate.select], b, a); });
  }
}

void LaneCircuit::clock() {
  for (std::size_t i = 0; i < next_.size(); ++i) {
    const FlipFlop& flip_flop = netlist_.flip_flops[i];
    const Lanes& state = values_[flip_flop.q];
    Lanes enable = values_[flip_flop.enable];
    if (!flip_flop.enable_high) {
      enable = ~enable;
    }
    Lanes next = choose(enable, values_[flip_flop.d], state);
    if (flip_flop.reset != kLow) {
      Lanes reset = values_[flip_flop.reset];
      if (!flip_flop.reset_high) {
        reset = ~reset;
      }
      if (flip_flop.reset_needs_enable) {
        reset = reset & enable;
      }
      next = flip_flop.reset_value ? next | reset : next & ~reset;
    }
    next_[i] = next;
  }
  for (LaneMemory& memory : memories_) {
    memory.clock(values_);
  }
  for (std::size_t i = 0; i < next_.size(); ++i) {
    values_[netlist_.flip_flops[i].q] = next_[i];
  }
  ++edges_;
}

}  // namespace dtof
