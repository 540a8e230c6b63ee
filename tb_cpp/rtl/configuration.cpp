// SPDX-License-Identifier: Apache-2.0
#include "rtl/configuration.hpp"

#include <fmt/format.h>

namespace dtof {

std::string RtlConfiguration::to_string() const {
  std::string out = parameters.to_string();
  if (is_pointer_readout(parameters.readout)) {
    out += fmt::format(" POINTER_PORTS={}", pointer_ports);
  }
  if (parameters.readout != Readout::kEzPointer) {
    out += fmt::format(" SIGNALLED_CLEAR={}", signalled_clear ? 1 : 0);
  }
  return out + fmt::format(" PIXELS_PER_SRAM={} SRAM_NUM={}", pixels_per_sram, sram_num);
}

std::string_view rtl_state_name(RtlState state) {
  static constexpr std::array<std::string_view, kRtlStateCount> kNames = {"IDLE", "RESET", "M0", "M1",
                                                                          "M2",   "M3",    "M4", "M5"};
  return kNames.at(static_cast<std::size_t>(state));
}

}  // namespace dtof
