// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/readout/pool_pointer.hpp"

namespace dtof {

/// Model of poolPointer that keeps candidates from frame to frame. Each read starts from `priors` and updates
/// it: one PoolPrior for each engine of the array, from the left; empty before the first frame. The array has
/// only the source's rows.
class PriorEngine final : public FrameEngine {
 public:
  /// `priors` must outlive the engine.
  PriorEngine(std::vector<PoolPrior>& priors, int threads) : priors_(&priors), threads_(threads) {}

  [[nodiscard]] bool reads_samples(Readout /*readout*/) const override { return false; }
  /// Throws InputError for a read-out other than poolPointer, and for a region that is not the whole source:
  /// the next frame needs priors of all engines.
  [[nodiscard]] ReadoutRun read(const StreamSource& source, const ReadoutParameters& parameters,
                                const Region& region) const override;

 private:
  std::vector<PoolPrior>* priors_;
  int threads_;
};

}  // namespace dtof
