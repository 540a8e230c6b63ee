// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "dtof/core/readout.hpp"

namespace dtof {

/// Which engine runs, how, and what is random.
struct RunSettings {
  std::string engine = "model";  ///< or "rtl", or "subsystem"
  bool verify = false;           ///< compares the hardware's pixels with the model's
  std::string trace;             ///< waveform file of the RTL; none if empty
  std::uint64_t seed = 1;
  int threads = 0;              ///< 0: all processors
  std::string columns = "all";  ///< as parse_columns has them
  std::string rows = "all";     ///< as parse_rows has them
  bool own_rows = false;        ///< a pool read-out's array has the source's rows alone
  bool streams_only = false;    ///< read streams even from a source that could be sampled

  [[nodiscard]] bool rtl() const { return engine == "rtl"; }
  [[nodiscard]] bool subsystem() const { return engine == "subsystem"; }
  [[nodiscard]] bool hardware() const { return rtl() || subsystem(); }
  /// What the engine can read out.
  [[nodiscard]] std::span<const Readout> readouts() const {
    return hardware() ? std::span<const Readout>(kRtlReadouts) : std::span<const Readout>(kAllReadouts);
  }
};

}  // namespace dtof
