// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/kept_streams.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"
#include "dtof/pipeline/frame_engine.hpp"
#include "dtof/readout/pool_pointer.hpp"

namespace dtof {

/// A candidate depth of a pool read-out's group, and the pixel's score for it.
struct PoolCandidate {
  std::int32_t cell;  ///< 0 .. 127, quarters of a coarse bin
  std::int32_t score;

  bool operator==(const PoolCandidate&) const = default;
};

/// How one pixel's results grow over a frame. The models have no view of their state, so each point is the
/// result of a frame of the same length whose light ends after some acquisitions. A pointer does not move
/// without detections, and a histogram counts none: the result is what the state says at that time.
class PixelTrace {
 public:
  /// Pixel of a frame. `source` and `engine` must outlive this object.
  PixelTrace(const StreamSource& source, const FrameEngine& engine, int column, int row)
      : source_(source), kept_(source, kMostBytes), engine_(engine), column_(column), row_(row) {}

  /// Result if the light ends before acquisition `until`. A pool read-out's `second` is the rival's position.
  [[nodiscard]] PixelResult result(const ReadoutParameters& readout, std::uint32_t until) const;
  /// Candidates of the pixel's group and the pixel's scores at acquisition `until`; empty for a read-out
  /// without candidates. Candidates change in the coarse phase, scores in the track phase.
  [[nodiscard]] std::vector<PoolCandidate> candidates(const ReadoutParameters& readout,
                                                      std::uint32_t until) const;

 private:
  static constexpr std::size_t kMostBytes = std::size_t{1} << 28U;  // a page has little memory

  const StreamSource& source_;
  KeptStreams kept_;  // whole columns, for pool read-outs
  const FrameEngine& engine_;
  int column_;
  int row_;
  mutable ColumnStream pixel_;  // the pixel's detections, once they were asked for
  mutable std::optional<ReadoutParameters> events_for_;
  mutable std::vector<PoolColumn> events_;  // of the pixel's group in that read-out, and of those around it
};

}  // namespace dtof
