// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/readout.hpp"

namespace dtof {

/// Which engine runs, how, and what is random.
struct RunSettings {
  std::string engine = "model";  ///< or "rtl"
  bool verify = false;           ///< compares the RTL's pixels with the model's
  std::string trace;             ///< waveform file of the RTL; none if empty
  std::uint64_t seed = 1;
  int threads = 0;              ///< 0: all processors
  std::string columns = "all";  ///< as parse_columns has them
  std::string rows = "all";     ///< as parse_rows has them
  bool streams_only = false;    ///< read streams even from a source that could be sampled

  [[nodiscard]] bool rtl() const { return engine == "rtl"; }
  /// What the engine can read out.
  [[nodiscard]] std::span<const Readout> readouts() const {
    return rtl() ? std::span<const Readout>(kRtlReadouts) : std::span<const Readout>(kModelReadouts);
  }
};

}  // namespace dtof
