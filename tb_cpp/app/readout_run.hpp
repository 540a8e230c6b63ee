// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "app/options.hpp"
#include "core/detection.hpp"
#include "core/parameters.hpp"
#include "core/result.hpp"

namespace dtof {

/// A frame read out by the chosen engine.
struct ReadoutRun {
  std::vector<PixelResult> results;  ///< index = row * n + i for the i-th of n columns read
  std::uint64_t cycles = 0;          ///< clocks of the frame; 0 for the model
  double seconds = 0.0;              ///< wall time, photon generation included
};

/// Reads `source` out with the engine of `options`; with --verify the RTL's pixels are compared with the
/// model's, and a difference is thrown as RtlError that describes it. `command` is the command line to
/// reproduce the run, without --columns and --trace.
ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunOptions& options, std::span<const int> columns, const std::string& command);

}  // namespace dtof
