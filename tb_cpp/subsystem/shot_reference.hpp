// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace dtof {

/// What the ports and the commands show in a clock, as far as shots depend on it.
struct ShotClock {
  bool begin = false;  ///< a frame begins
  bool done = false;   ///< the array's frame ends
  bool abort = false;
  bool flush = false;
  bool gave_up = false;    ///< the watchdog ends the frame for the source
  bool reseed = false;     ///< SHOT_SEED was written
  bool arrives = false;    ///< an acquisition's first line is accepted
  bool rest_ends = false;  ///< a line with tlast is thrown away
  bool inside = false;     ///< the source is inside an acquisition
  bool early = false;      ///< the source is not to be asked yet
  bool dropped = false;    ///< the acquisition that arrives is thrown away
  bool taken = false;      ///< the array takes an acquisition's first line
};

/// When shot_o must be high, as integration.md says: a shot for each acquisition that the frame needs and
/// nobody has or owes, two clocks and the delay behind the request for it.
class ShotReference {
 public:
  struct Settings {
    std::uint32_t acquisitions = 0;
    std::uint32_t bits = 0;
    std::uint32_t unit = 1;
  };

  void reset() { *this = ShotReference(); }
  /// Those of the frame that begins in this clock, and the seed that was written last.
  void set(const Settings& settings) { next_ = settings; }
  void set_seed(std::uint32_t seed) { seed_ = seed; }

  /// One clock. Returns whether shot_o must be high in it.
  bool clock(const ShotClock& now);

  /// The register's state when the last frame began.
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
  bool rest_ = false;      // behind an abort, of the acquisition that the source was in
  bool draining_ = false;  // the array takes what is no detection
};

}  // namespace dtof
