// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/result_word.hpp"

#include <fmt/format.h>

#include <bit>

#include "dtof/core/error.hpp"
#include "fault_metrics/lane_frame.hpp"

namespace dtof {
namespace {

/// dtof_pkg::index_width.
int index_width(int count) {
  return count > 2 ? static_cast<int>(std::bit_width(static_cast<unsigned>(count - 1))) : 1;
}

}  // namespace

ResultWord::ResultWord(const GateNetlist& netlist)
    : column_width(index_width(netlist.columns)), row_width(index_width(netlist.rows)) {
  const ReadoutParameters parameters = netlist_configuration(netlist).parameters;
  code_width = parameters.np;
  fraction_width = parameters.fraction_bits;
  const auto width = static_cast<int>(netlist.port("result_tdata_o").size());
  confidence_width = width - column_width - row_width - code_width - fraction_width;
  if (confidence_width < 0) {
    throw InputError(fmt::format("result_tdata_o of {} has {} bits, too few", netlist.readout, width));
  }
}

}  // namespace dtof
