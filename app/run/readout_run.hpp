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

/// Throws InputError for what `run_readout` would refuse of an engine that is hardware: a read-out that is
/// not compiled for so many rows, more acquisitions than the RTL's 16 bits count, or more columns than a
/// trace holds. To be asked before anything is written.
void check_engine(const StreamSource& source, std::span<const ReadoutParameters> readouts,
                  const RunSettings& options, const Region& region);

/// The read-outs of `--readout all` without those that pool pixels and whose RTL is not compiled for the
/// source's columns, each of which is named on standard output. All of them if the engine is not the RTL.
std::vector<ReadoutParameters> without_unfit_engines(const StreamSource& source,
                                                     std::vector<ReadoutParameters> readouts,
                                                     const RunSettings& options, const Region& region);

/// True if run_readout asks a photon source that can be sampled (SampledSource) for the photons of one
/// measurement at a time; false if it reads streams: hardware, the pool read-outs, --record.
bool reads_samples(Readout readout, const RunSettings& options);

/// Reads a region of `source` out with the engine of `options`, which does not change a result. A pool
/// read-out's array has the sensor's rows, at least the 160 of the compiled arrays, and those outside the
/// region are dark. With --verify the hardware's pixels are compared with the model's, and a difference is
/// thrown as RtlError that describes it. `command` is the command line to reproduce the run, without
/// --columns and
/// --trace. Throws InputError for a region outside the source.
ReadoutRun run_readout(const StreamSource& source, const ReadoutParameters& parameters,
                       const RunSettings& options, const Region& region, const std::string& command);

/// The same for a FramePipeline. The settings must outlive the engine.
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
