// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/parameters.hpp"
#include "dtof/core/progress.hpp"
#include "dtof/host/range_converter.hpp"
#include "dtof/metrics/error_shares.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/sensor_model.hpp"
#include "dtof/photon/target_map.hpp"
#include "dtof/readout/pool_pointer.hpp"
#include "dtof/scene/sequence.hpp"

namespace dtof {

/// A frame of a video and the results of all estimators.
struct VideoFrame {
  TargetMap targets;
  std::vector<std::vector<double>> distance_m;  ///< [estimator][row * columns + column]
  std::vector<ErrorShares> shares;              ///< for each estimator, over all pixels with a target
};

/// Reads out videos with the models of several read-outs, each frame on its own. If poolPointer is among
/// them, a further estimator is poolPointer with the last frame's candidates as prior
/// (`readout/pool_pointer.hpp`, PoolPrior). All estimators see the same photons, and each frame has new ones.
/// Frames are read by FramePipeline from an array with the sensor's rows; the look-up tables are calibrated
/// at one light level.
class VideoReader {
 public:
  VideoReader(SensorModel sensor, std::span<const ReadoutParameters> readouts, double table_klux,
              std::uint64_t seed, int threads);

  /// Titles of the estimators: the read-outs, then poolPointer with its prior.
  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }
  /// Index of poolPointer without prior among the estimators; none if it is not read.
  [[nodiscard]] std::optional<std::size_t> without_prior() const { return pool_; }

  using Watcher = std::function<void(int frame, const VideoFrame& seen)>;
  /// Error shares [frame][estimator]. Calls `watch` with each frame as soon as it is read.
  [[nodiscard]] std::vector<std::vector<ErrorShares>> read(const Sequence& sequence,
                                                           Progress* progress = nullptr,
                                                           const Watcher& watch = {}) const;

 private:
  /// Reads a frame and updates poolPointer's `priors`.
  [[nodiscard]] VideoFrame read_frame(const SequenceFrame& frame, std::uint32_t number,
                                      std::vector<PoolPrior>& priors) const;

  SensorModel sensor_;
  std::vector<ReadoutParameters> readouts_;
  std::optional<std::size_t> pool_;
  std::vector<std::string> titles_;
  std::vector<RangeConverter> tables_;  ///< for each estimator
  std::uint64_t seed_;
  int threads_;
};

}  // namespace dtof
