// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dtof/core/readout.hpp"

namespace dtof {

/// Engine of a run, its options, and the seed.
struct RunSettings {
  std::string engine = "model";  ///< "model", "rtl" or "subsystem"
  bool verify = false;           ///< compare the hardware's pixels with the model's
  std::string trace;             ///< waveform file of the RTL; empty: none
  std::uint64_t seed = 1;
  int threads = 0;              ///< 0: all processors
  std::string columns = "all";  ///< for parse_columns
  std::string rows = "all";     ///< for parse_rows
  bool own_rows = false;        ///< a pool read-out's array has only the source's rows
  bool streams_only = false;    ///< read streams even if the source can be sampled

  [[nodiscard]] bool rtl() const { return engine == "rtl"; }
  [[nodiscard]] bool subsystem() const { return engine == "subsystem"; }
  [[nodiscard]] bool hardware() const { return rtl() || subsystem(); }
  /// Read-outs that the engine supports.
  [[nodiscard]] std::span<const Readout> readouts() const {
    return hardware() ? std::span<const Readout>(kRtlReadouts) : std::span<const Readout>(kAllReadouts);
  }
};

}  // namespace dtof
