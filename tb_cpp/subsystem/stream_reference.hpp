// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// One timestamp for every column.
using Line = std::vector<Timestamp>;

/// Events at the ports, as ERROR and WARNING must show them.
struct SubsystemEvents {
  bool underrun = false;
  bool overrun = false;
  bool short_acquisition = false;  ///< tlast was early
  bool long_acquisition = false;   ///< tlast was late
  bool timeout = false;
  bool stalled = false;
  bool aborted = false;

  bool operator==(const SubsystemEvents&) const = default;
};

/// Reference for the subsystem's line stream (docs/user/integration.md): which of the source's lines reach
/// the array, and in which place. It stores whole acquisitions and does not model the line memory.
class StreamReference {
 public:
  StreamReference(std::size_t acquisition_lines, Timestamp none)
      : acquisition_lines_(acquisition_lines), none_(none) {}

  /// Resets the reference, including settings that a bench changes between frames.
  void reset();
  void set_release(std::size_t lines) { release_ = lines; }
  /// Parameters with which the subsystem was built.
  struct Build {
    bool clock_waits = false;
    bool source_waits = true;
    std::size_t buffer_lines = 0;
    std::size_t slots = 1;
  };
  void set_build(const Build& build) { build_ = build; }
  void set_watchdog(std::uint32_t clocks) { watchdog_ = clocks; }

  /// The following functions describe one clock at the ports, in this order. take(): the array takes `line`;
  /// throws RtlError if it must not, or if the line is a different one.
  void take(const Line& line);
  /// States of the array and sink. Throws RtlError if the array waits although an acquisition is available,
  /// or if its clock stops although a line is available. A timeout in the clock of an abort is not reported.
  struct Waits {
    bool array_ready;
    bool array_valid;
    bool array_rests;
    bool sink_refuses;
    bool line_stored;
    bool aborts;
  };
  void wait(const Waits& now);
  /// The source's line is accepted. `thrown`: in the clock of an abort or a flush, when a source that cannot
  /// wait continues.
  void accept(const Line& line, bool last, bool thrown);
  /// The line is dropped because the buffer is full; the rest of its acquisition is dropped, too.
  void drop(bool last);
  void begin();
  void done();
  void abort();
  void flush();

  /// True if a line may be refused in this clock although there is room: the watchdog expired in the last
  /// clock.
  [[nodiscard]] bool expires() const { return expires_; }
  /// True if the watchdog ended the frame for the source in this clock.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  /// True if the array waits for an acquisition, or for a line inside one.
  [[nodiscard]] bool starved() const { return starved_; }
  /// True if the array is inside an acquisition.
  [[nodiscard]] bool inside() const { return index_ > 0; }
  /// Number of lines that wait for the array, and (next function) whether it is exact, i.e. no line was
  /// discarded.
  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  [[nodiscard]] bool exact() const { return exact_; }
  /// True if lines of the source are discarded up to the next tlast.
  [[nodiscard]] bool hunting() const { return hunting_; }
  /// True if it is too early, after `wait`, to ask the source for an acquisition in this clock.
  [[nodiscard]] bool early() const {
    if (rest_) {
      return true;
    }
    if (build_.clock_waits) {
      return source_index_ > 0 ? source_index_ < release_ : release_ == acquisition_lines_ && !starved_;
    }
    return cannot_hold() && (source_index_ > 0 || !starved_);
  }
  /// Lines of the source's current acquisition that have arrived.
  [[nodiscard]] std::size_t source_index() const { return source_index_; }
  /// Acquisitions of the frame in which the buffer ran empty.
  [[nodiscard]] std::uint32_t underruns() const { return underruns_; }
  [[nodiscard]] SubsystemEvents& events() { return events_; }
  /// Counts since reset. The number of lines may be smaller by `doubtful_lines`, which were being read when
  /// an abort came.
  [[nodiscard]] std::uint64_t lost_lines() const { return lost_lines_; }
  [[nodiscard]] std::uint64_t doubtful_lines() const { return doubtful_lines_; }
  [[nodiscard]] std::uint64_t lost_acquisitions() const { return lost_acquisitions_; }

 private:
  struct Acquisition {
    std::vector<Line> lines;
    bool ended = false;
  };

  void empty();
  void expect_rest(bool here) const;
  [[nodiscard]] bool dark(const Line& line) const;
  /// True if an acquisition neither waits at the source nor fits the buffer.
  [[nodiscard]] bool cannot_hold() const {
    return !build_.source_waits && build_.buffer_lines < acquisition_lines_;
  }
  /// Lines with which the array is offered an acquisition whose end has not arrived. An acquisition that the
  /// buffer cannot hold is offered while the lines that come until the array begins find room.
  [[nodiscard]] std::size_t offered_from() const {
    return cannot_hold() ? std::min(release_, build_.buffer_lines - (build_.slots - 1)) : release_;
  }

  std::size_t acquisition_lines_;
  Timestamp none_;
  std::size_t release_ = 0;
  Build build_;
  std::uint32_t watchdog_ = 0;
  std::deque<Acquisition> acquisitions_;  // first: the array's current one; the last may be incomplete
  std::size_t waiting_ = 0;
  std::size_t source_index_ = 0;
  bool hunting_ = false;
  bool rest_ = false;      // as above, and neither an abort nor a timeout ended the acquisition
  bool late_ = false;      // the source's acquisition was already ended for the array by an underrun
  std::size_t index_ = 0;  // line within the array's acquisition
  bool missing_ = false;   // the rest of the acquisition is dark
  bool draining_ = false;  // the rest of the frame is dark
  bool running_ = false;
  bool starved_ = false;
  bool expires_ = false;
  bool gave_up_ = false;
  bool stalls_ = false;
  bool waits_ = false;         // the watchdog's wait in the last clock; it counts a clock later
  bool sink_refused_ = false;  // likewise
  std::uint32_t waited_ = 0;
  std::uint32_t withheld_ = 0;  // clocks in which an acquisition was available and not offered
  std::uint32_t refused_ = 0;
  bool exact_ = true;
  std::uint32_t underruns_ = 0;
  SubsystemEvents events_;
  std::uint64_t lost_lines_ = 0;
  std::uint64_t doubtful_lines_ = 0;
  std::uint64_t lost_acquisitions_ = 0;
};

}  // namespace dtof
