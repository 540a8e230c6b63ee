// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fault_metrics/gate_netlist.hpp"
#include "fault_metrics/lanes.hpp"

namespace dtof {

/// The contents of a memory in every lane. Behaves as hdl/technology/behavioural: a word that is read in the
/// clock in which it is written is read inverted, because no logic may use it.
class LaneMemory {
 public:
  /// All lanes begin with the same random contents.
  LaneMemory(const Memory& memory, std::uint64_t seed);

  /// A rising clock edge. `values`: value of every net before the edge.
  void clock(std::span<const Lanes> values);
  /// The word that the memory shows since the last read, a value per bit.
  [[nodiscard]] std::span<const Lanes> read_data() const { return read_data_; }

  /// A stored bit, index = address * width + bit.
  void flip(std::size_t bit, std::size_t lane);
  /// From now on the stored bit keeps this value in this lane.
  void stick(std::size_t bit, std::size_t lane, bool value);

 private:
  struct Stuck {
    std::size_t bit;
    std::size_t lane;
    bool value;
  };

  void read(std::span<const Lanes> values, const Lanes& enable, const Lanes& written);
  void write(std::span<const Lanes> values, const Lanes& enable);

  const Memory& memory_;
  std::vector<Lanes> bits_;
  std::vector<Lanes> read_data_;
  std::vector<Stuck> stuck_;
};

}  // namespace dtof
