// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dtof {

/// Part of an array to which an element of its netlist belongs.
enum class CircuitPart {
  kColumns,        ///< timestamps' registers, filters, pointers, peaks of the columns
  kMemoryControl,  ///< addresses, enables and data on their way to the SRAMs
  kEngines,        ///< poolPointer: what the columns of an engine share
  kControl,        ///< controller, sequencers, broadcast registers
  kOutput,         ///< result registers and result output
  kParityCheck,    ///< XOR trees, error flip-flops and the way of the errors to the port
  kWords,          ///< data bits of the SRAMs
  kParityBits,     ///< parity bits of the SRAMs
};

inline constexpr std::array kCircuitParts = {
    CircuitPart::kColumns, CircuitPart::kMemoryControl, CircuitPart::kEngines, CircuitPart::kControl,
    CircuitPart::kOutput,  CircuitPart::kParityCheck,   CircuitPart::kWords,   CircuitPart::kParityBits,
};

/// How often an element occurs in an array of another size: once per column, per engine or per array.
enum class Repeated { kColumn, kEngine, kArray };

/// E.g. "memory control".
std::string_view part_title(CircuitPart part);

/// Part of a cell with this hierarchical name, e.g.
/// "$flatten\g_column[0].u_column.\u_result_register.$abc$1".
CircuitPart part_of_cell(std::string_view name);

/// Where the cell with this hierarchical name is. The store of a pool array's parities counts as a part of
/// the columns, because most of it is there once for each SRAM.
Repeated repeated_of_cell(std::string_view name);

/// Number of parity bits in a word of this memory of an array with parity. `width`: bits of the word.
std::uint32_t parity_bits_of_memory(std::string_view name, std::uint32_t width);

}  // namespace dtof
