// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "fault_metrics/gate_netlist.hpp"

namespace dtof {

/// Fields of result_tdata_o: column, row, code, fraction, confidence, the last in the lowest bits.
struct ResultWord {
  int column_width = 0;
  int row_width = 0;
  int code_width = 0;
  int fraction_width = 0;
  int confidence_width = 0;

  /// Fields of an array of `netlist`. Throws InputError if the port is too narrow for them.
  explicit ResultWord(const GateNetlist& netlist);

  [[nodiscard]] std::uint64_t confidence(std::uint64_t word) const { return low(word, confidence_width); }
  /// Code and fraction as one number.
  [[nodiscard]] std::uint64_t position(std::uint64_t word) const {
    return low(word >> confidence_width, code_width + fraction_width);
  }
  [[nodiscard]] std::uint64_t row(std::uint64_t word) const { return low(word >> address_lsb(), row_width); }
  [[nodiscard]] std::uint64_t column(std::uint64_t word) const {
    return low(word >> (address_lsb() + row_width), column_width);
  }
  /// Column and row as one number.
  [[nodiscard]] std::uint64_t address(std::uint64_t word) const { return word >> address_lsb(); }

 private:
  [[nodiscard]] int address_lsb() const { return confidence_width + code_width + fraction_width; }
  static std::uint64_t low(std::uint64_t word, int width) {
    return word & ((std::uint64_t{1} << width) - 1U);
  }
};

}  // namespace dtof
