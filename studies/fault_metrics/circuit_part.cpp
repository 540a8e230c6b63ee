// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/circuit_part.hpp"

#include <stdexcept>

namespace dtof {

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
  const auto in = [name](std::string_view instance) { return name.find(instance) != std::string_view::npos; };
  if (in("u_parity_")) {
    return CircuitPart::kParityCheck;
  }
  if (in("u_words.")) {  // the multiplexer of addresses of a single-port SRAM
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
  if (name.find("g_engine[") != std::string_view::npos) {
    return Repeated::kEngine;
  }
  const bool in_column =
      name.find("g_column[") != std::string_view::npos || name.find("g_quad[") != std::string_view::npos;
  return in_column ? Repeated::kColumn : Repeated::kArray;
}

}  // namespace dtof
