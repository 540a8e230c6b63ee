// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace dtof {

/// Events of a clock on which shots depend.
struct ShotClock {
  bool begin = false;  ///< a frame begins
  bool done = false;   ///< the array's frame ends
  bool abort = false;
  bool flush = false;
  bool gave_up = false;    ///< the watchdog ends the frame for the source
  bool reseed = false;     ///< SHOT_SEED was written
  bool arrives = false;    ///< an acquisition's first line is accepted
  bool rest_ends = false;  ///< a line with tlast is discarded
  bool inside = false;     ///< the source is inside an acquisition
  bool early = false;      ///< it is too early to ask the source
  bool dropped = false;    ///< the arriving acquisition is discarded
  bool taken = false;      ///< the array takes an acquisition's first line
};

/// Reference for shot_o (docs/user/integration.md): one shot for each acquisition that the frame needs and
/// that is neither buffered nor already requested. The shot is two clocks plus the dither delay after the
/// request.
class ShotReference {
 public:
  struct Settings {
    std::uint32_t acquisitions = 0;
    std::uint32_t bits = 0;
    std::uint32_t unit = 1;
  };

  void reset() { *this = ShotReference(); }
  /// Settings for the frame that begins in this clock, with the last seed written.
  void set(const Settings& settings) { next_ = settings; }
  void set_seed(std::uint32_t seed) { seed_ = seed; }

  /// Advances by one clock. Returns whether shot_o must be high in it.
  bool clock(const ShotClock& now);

  /// State of the shift register when the last frame began.
  [[nodiscard]] std::uint32_t first_state() const { return first_state_; }

 private:
  void step();

  Settings next_;
  Settings frame_;
  std::uint32_t seed_ = 1;
  std::uint32_t state_ = 1;
  std::uint32_t first_state_ = 1;
  std::uint64_t now_ = 0;
  std::optional<std::uint64_t> due_;  // the clock of a shot that was requested
  std::uint32_t need_ = 0;            // acquisitions of the frame that the array has not begun
  std::uint32_t queued_ = 0;          // acquisitions that have begun to arrive, and the array has not begun
  bool owed_ = false;
  bool rest_ = false;      // rest of the acquisition that the source was in at an abort
  bool draining_ = false;  // the array takes lines without detections
};

}  // namespace dtof
