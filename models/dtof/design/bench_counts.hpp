// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dtof/design/bench.hpp"
#include "dtof/metrics/error_statistics.hpp"

namespace dtof {

// Frame numbers of the sky: those that set thresholds, and those that are held out.
inline constexpr std::uint32_t kSkyFrame = 1'000'000;
inline constexpr std::uint32_t kHeldOutSky = 2'000'000;

/// A pixel with a target is detected if its error is at most this share of the distance.
inline constexpr double kRight = 0.10;

/// Number of frames of sky in which the share of false alarms shows, for frames of so many pixels.
std::uint32_t sky_frames(const BenchSettings& settings, std::size_t pixels);

/// Counts of one read-out or rival in one frame of some scenes.
struct FrameCounts {
  std::uint64_t pixels = 0;
  std::uint64_t above_3 = 0;
  std::uint64_t above_10 = 0;
  std::uint64_t detected = 0;
  double squares = 0.0;

  /// Adds the judged pixels of one scene. `mean_square`: of their errors in m2.
  void add(const ErrorStatistics& errors, double mean_square);
};

/// Counts of one read-out or rival in one light, over several frames.
class LightCounts {
 public:
  /// Throws InputError if no pixel of the frame was judged.
  void add(const FrameCounts& frame);

  /// Pixels of one frame.
  [[nodiscard]] std::uint64_t pixels() const { return pixels_ / above_3_.size(); }
  /// Shares with their intervals. Without `detection`, P_d is left out, and always P_fa.
  [[nodiscard]] LightScore score(double klux, bool detection) const;

 private:
  [[nodiscard]] Estimate share(const std::vector<double>& frames) const;

  std::vector<double> above_3_;  // share of each frame's pixels
  std::vector<double> above_10_;
  std::vector<double> detected_;
  double squares_ = 0.0;
  std::uint64_t pixels_ = 0;  // of all frames
};

}  // namespace dtof
