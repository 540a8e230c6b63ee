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

/// A frame of a video and what the read-outs made of it.
struct VideoFrame {
  TargetMap targets;
  std::vector<std::vector<double>> distance_m;  ///< of each estimator; index = row * columns + column
  std::vector<ErrorShares> shares;              ///< of each estimator, over all pixels that have a target
};

/// Reads videos out with the models of several read-outs, each frame on its own; and, if poolPointer is
/// among them, once more with one that begins each frame from what the last one left
/// (`readout/pool_pointer.hpp`, PoolPrior). All see the same photons, other ones in each frame. A frame
/// is that of FramePipeline, of an array with the sensor's rows alone; the look-up tables are of one light.
class VideoReader {
 public:
  VideoReader(SensorModel sensor, std::span<const ReadoutParameters> readouts, double table_klux,
              std::uint64_t seed, int threads);

  /// Titles of the read-outs; poolPointer with its prior comes last.
  [[nodiscard]] const std::vector<std::string>& estimators() const { return titles_; }
  /// Which of the estimators is poolPointer without its prior; none if it is not read.
  [[nodiscard]] std::optional<std::size_t> without_prior() const { return pool_; }

  using Watcher = std::function<void(int frame, const VideoFrame& seen)>;
  /// Error shares; index: frame, estimator. Each frame is shown to `watch` as soon as it is read.
  [[nodiscard]] std::vector<std::vector<ErrorShares>> read(const Sequence& sequence,
                                                           Progress* progress = nullptr,
                                                           const Watcher& watch = {}) const;

 private:
  /// A frame; `priors` are poolPointer's, before and after it.
  [[nodiscard]] VideoFrame read_frame(const SequenceFrame& frame, std::uint32_t number,
                                      std::vector<PoolPrior>& priors) const;

  SensorModel sensor_;
  std::vector<ReadoutParameters> readouts_;
  std::optional<std::size_t> pool_;
  std::vector<std::string> titles_;
  std::vector<RangeConverter> tables_;  ///< of each estimator
  std::uint64_t seed_;
  int threads_;
};

}  // namespace dtof
