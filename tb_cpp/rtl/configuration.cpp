// SPDX-License-Identifier: Apache-2.0
#include "rtl/configuration.hpp"

#include <fmt/format.h>

namespace dtof {

std::string RtlConfiguration::to_string() const {
  std::string out = parameters.to_string();
  if (parity) {
    out += " PARITY=1";
  }
  if (is_pool_readout(parameters.readout)) {
    return out + fmt::format(" PIXELS_PER_SRAM={} SRAM_NUM={}", pixels_per_sram, sram_num);
  }
  if (is_pointer_readout(parameters.readout)) {
    out += fmt::format(" POINTER_PORTS={}", pointer_ports);
  }
  if (has_histogram(parameters.readout)) {
    out += fmt::format(" SIGNALLED_CLEAR={}", signalled_clear ? 1 : 0);
  }
  if (raw_histogram) {
    out += " RAW_HISTOGRAM=1";
  }
  return out + fmt::format(" PIXELS_PER_SRAM={} SRAM_NUM={}", pixels_per_sram, sram_num);
}

std::vector<ResultAddress> RtlConfiguration::result_order() const {
  // Without engines every column is one of its own.
  const int turns = is_pool_readout(parameters.readout) ? parameters.pool.engine_columns : 1;
  std::vector<ResultAddress> order;
  for (int turn = 0; turn < turns; ++turn) {
    for (int row = 0; row < pixels_per_sram; ++row) {
      for (int column = turn; column < sram_num; column += turns) {
        order.push_back({row, column, column == turn});
      }
    }
  }
  return order;
}

std::string_view rtl_state_name(RtlState state) {
  static constexpr std::array<std::string_view, kRtlStateCount> kNames = {"IDLE", "RESET", "M0", "M1",
                                                                          "M2",   "M3",    "M4", "M5"};
  return kNames.at(static_cast<std::size_t>(state));
}

}  // namespace dtof
