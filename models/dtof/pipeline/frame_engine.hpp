// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/core/result.hpp"
#include "dtof/pipeline/region.hpp"

namespace dtof {

/// A frame read out by an engine.
struct ReadoutRun {
  std::vector<PixelResult> results;  ///< of the region, as Region says
  std::uint64_t cycles = 0;          ///< clocks of a frame in `array`; 0 for the model, or if not known
  std::string array;                 ///< "200 columns of 160 rows"; empty for the model
  double seconds = 0.0;              ///< wall time, photon generation included
};

/// What turns photons into results: the models, or hardware that a program brings along.
class FrameEngine {
 public:
  FrameEngine() = default;
  FrameEngine(const FrameEngine&) = default;
  FrameEngine& operator=(const FrameEngine&) = default;
  FrameEngine(FrameEngine&&) = default;
  FrameEngine& operator=(FrameEngine&&) = default;
  virtual ~FrameEngine() = default;

  /// True if `read` asks a source that can be sampled (SampledSource) for the photons of one measurement at a
  /// time; false if it reads streams.
  [[nodiscard]] virtual bool reads_samples(Readout readout) const = 0;
  /// Reads a region of the source out. Throws InputError for a region outside of it.
  [[nodiscard]] virtual ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                        const Region& region) const = 0;
};

/// The bit-exact models. A pool read-out's array has the sensor's rows, by default at least kArrayRows, and
/// those outside the region are dark.
class ModelEngine final : public FrameEngine {
 public:
  struct Settings {
    int threads = 0;            ///< 0: all processors
    bool streams_only = false;  ///< read streams even from a source that could be sampled
    bool own_rows = false;      ///< a pool read-out's array has the sensor's rows alone, however few
    /// Is told which column of how many is done; none: the progress is on standard error.
    Progress::Observer observer = {};
  };

  explicit ModelEngine(Settings settings) : settings_(std::move(settings)) {}

  [[nodiscard]] bool reads_samples(Readout readout) const override {
    return !settings_.streams_only && !is_pool_readout(readout);
  }
  [[nodiscard]] ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                const Region& region) const override;

 private:
  Settings settings_;
};

}  // namespace dtof
