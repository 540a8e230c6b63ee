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

/// Results of a frame that an engine read out.
struct ReadoutRun {
  std::vector<PixelResult> results;  ///< pixels of the region, row-major (Region)
  std::uint64_t cycles = 0;          ///< clocks of a frame in `array`; 0 for the models, or if unknown
  std::string array;                 ///< e.g. "200 columns of 160 rows"; empty for the models
  double seconds = 0.0;              ///< wall time in s, photon generation included
};

/// Converts photons into results. Implementations: the models (ModelEngine), or hardware that a program
/// provides.
class FrameEngine {
 public:
  FrameEngine() = default;
  FrameEngine(const FrameEngine&) = default;
  FrameEngine& operator=(const FrameEngine&) = default;
  FrameEngine(FrameEngine&&) = default;
  FrameEngine& operator=(FrameEngine&&) = default;
  virtual ~FrameEngine() = default;

  /// True if `read` draws the photons from a SampledSource measurement by measurement; false if it reads
  /// streams.
  [[nodiscard]] virtual bool reads_samples(Readout readout) const = 0;
  /// Reads out a region of `source`. Throws InputError for a region outside `source`.
  [[nodiscard]] virtual ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                        const Region& region) const = 0;
};

/// The bit-exact models. A pool read-out's array has the sensor's rows, at least kArrayRows by default; rows
/// outside the region are dark.
class ModelEngine final : public FrameEngine {
 public:
  struct Settings {
    int threads = 0;            ///< 0: all processors
    bool streams_only = false;  ///< read streams even if the source can be sampled
    bool own_rows = false;  ///< a pool read-out's array has only the sensor's rows, even if below kArrayRows
    /// Called with the columns done and the total; null: progress goes to standard error.
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
