// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parameters.hpp"
#include "core/progress.hpp"
#include "host/range_converter.hpp"
#include "photon/sensor_model.hpp"
#include "scene/sequence.hpp"
#include "study/scene_study.hpp"

namespace dtof {

/// Reads videos out with the models of several read-outs, each frame on its own, and with poolPointer 2 that
/// begins each frame from what the last one left (`readout/pool_pointer2.hpp`, PoolPrior). All see the same
/// photons, other ones in each frame. Distances come from look-up tables by FlatCalibration at one light.
class VideoStudy {
 public:
  static constexpr const char* kWithPrior = "poolPointer 2, prior";

  /// Throws InputError unless poolPointer 2 is among the read-outs.
  VideoStudy(SensorModel sensor, std::span<const ReadoutParameters> readouts, double table_klux,
             std::uint64_t seed, int threads);

  /// Titles of the read-outs, kWithPrior last.
  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }

  /// Error shares of every pixel; index: frame, estimator.
  [[nodiscard]] std::vector<std::vector<ErrorShares>> measure(const Sequence& sequence,
                                                              Progress* progress = nullptr) const;

 private:
  SensorModel sensor_;
  std::vector<ReadoutParameters> readouts_;
  std::size_t pool2_;  ///< which of them is poolPointer 2
  std::vector<std::string> titles_;
  std::vector<RangeConverter> tables_;  ///< of each estimator
  std::uint64_t seed_;
  int threads_;
};

/// Pixels of several frames together; the rmse over all of them.
ErrorShares pooled(std::span<const ErrorShares> frames);

}  // namespace dtof
