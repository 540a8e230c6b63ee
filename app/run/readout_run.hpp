// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "run/region.hpp"
#include "run/run_settings.hpp"

namespace dtof {

/// Checks, before any output is written, what `run_readout` would refuse for a hardware engine. Throws
/// InputError for a read-out that is not compiled for this number of rows, more acquisitions than the RTL's
/// 16 bits count, or more columns than a trace holds.
void check_engine(const StreamSource& source, std::span<const ReadoutParameters> readouts,
                  const RunSettings& options, const Region& region);

/// Removes from `--readout all` the pool read-outs whose RTL is not compiled for the source's columns, and
/// prints their names on standard output. Returns all read-outs if the engine is not the RTL.
std::vector<ReadoutParameters> without_unfit_engines(const StreamSource& source,
                                                     std::vector<ReadoutParameters> readouts,
                                                     const RunSettings& options, const Region& region);

/// True if run_readout draws the photons from a SampledSource measurement by measurement. False if it reads
/// streams: hardware, pool read-outs, --record.
bool reads_samples(Readout readout, const RunSettings& options);

/// Reads out a region of `source` with the engine of `options`; the engine does not change results. A pool
/// read-out's array has the sensor's rows, at least the 160 of the compiled arrays; rows outside the region
/// are dark. With --verify the hardware's pixels are compared with the model's; a difference throws RtlError
/// that describes it. `command` is the command line of the run. Throws InputError for a region outside the
/// source.
ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunSettings& options, const Region& region, const std::string& command);

/// run_readout as an engine of FramePipeline. The settings must outlive the engine.
class ProgramEngine final : public FrameEngine {
 public:
  ProgramEngine(const RunSettings& settings, std::string command)
      : settings_(settings), command_(std::move(command)) {}

  [[nodiscard]] bool reads_samples(Readout readout) const override {
    return dtof::reads_samples(readout, settings_);
  }
  [[nodiscard]] ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                const Region& region) const override {
    return run_readout(source, parameters, settings_, region, command_);
  }

 private:
  const RunSettings& settings_;
  std::string command_;
};

}  // namespace dtof
