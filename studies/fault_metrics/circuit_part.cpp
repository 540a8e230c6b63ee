// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/circuit_part.hpp"

#include <stdexcept>

namespace dtof {
namespace {

constexpr std::uint32_t kScratchParities = 4;  // dtof_pkg::POOL_SCRATCH_PARITIES
constexpr std::string_view kParityStore = "u_parity_store.";

bool contains(std::string_view name, std::string_view part) {
  return name.find(part) != std::string_view::npos;
}

/// A dtof_sram; the parities of its words are in kParityStore.
bool in_sram_of_quad(std::string_view name) { return contains(name, "g_quad[") && contains(name, "u_sram."); }

}  // namespace

std::string_view part_title(CircuitPart part) {
  switch (part) {
    case CircuitPart::kColumns:
      return "columns";
    case CircuitPart::kMemoryControl:
      return "memory control";
    case CircuitPart::kEngines:
      return "engines";
    case CircuitPart::kControl:
      return "control";
    case CircuitPart::kOutput:
      return "result output";
    case CircuitPart::kParityCheck:
      return "parity check";
    case CircuitPart::kWords:
      return "SRAM words";
    case CircuitPart::kParityBits:
      return "SRAM parity bits";
  }
  throw std::logic_error("a part of no array");
}

CircuitPart part_of_cell(std::string_view name) {
  const auto in = [name](std::string_view instance) { return contains(name, instance); };
  if (in("u_parity_") || in("u_word_parity.")) {
    return CircuitPart::kParityCheck;
  }
  if (in("u_words.") || in_sram_of_quad(name)) {  // the multiplexer of addresses of a single-port SRAM
    return CircuitPart::kMemoryControl;
  }
  if (in("_sram.") || in("u_sram.")) {  // dtof_parity_sram
    return CircuitPart::kParityCheck;
  }
  if (in("u_result_output.") || in("u_result_register.")) {
    return CircuitPart::kOutput;
  }
  if (in("g_engine[")) {
    return CircuitPart::kEngines;
  }
  if (in("u_word_builder.") || in("u_histogram_builder.") || (in("g_quad[") && !in("g_pair["))) {
    return CircuitPart::kMemoryControl;
  }
  return in("g_column[") || in("g_quad[") ? CircuitPart::kColumns : CircuitPart::kControl;
}

Repeated repeated_of_cell(std::string_view name) {
  if (contains(name, "g_engine[")) {
    return Repeated::kEngine;
  }
  const bool in_column =
      contains(name, "g_column[") || contains(name, "g_quad[") || contains(name, kParityStore);
  return in_column ? Repeated::kColumn : Repeated::kArray;
}

std::uint32_t parity_bits_of_memory(std::string_view name, std::uint32_t width) {
  if (contains(name, kParityStore)) {
    return width;
  }
  if (in_sram_of_quad(name)) {
    return 0;
  }
  return contains(name, "u_scratch_sram.") ? kScratchParities : 1;
}

}  // namespace dtof
