// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/readout/pool_pointer.hpp"

namespace dtof {

/// poolPointer's model with what the last frame left: each read begins from `priors` and leaves its own
/// there, a PoolPrior for each engine of the array from the left; none before the first frame. The array
/// has the source's rows alone.
class PriorEngine final : public FrameEngine {
 public:
  /// `priors` must outlive the engine.
  PriorEngine(std::vector<PoolPrior>& priors, int threads) : priors_(&priors), threads_(threads) {}

  [[nodiscard]] bool reads_samples(Readout /*readout*/) const override { return false; }
  /// Throws InputError for a read-out that is not poolPointer, and for a region that is not the whole source:
  /// a frame of a video leaves something for all of the next one.
  [[nodiscard]] ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                const Region& region) const override;

 private:
  std::vector<PoolPrior>* priors_;
  int threads_;
};

}  // namespace dtof
