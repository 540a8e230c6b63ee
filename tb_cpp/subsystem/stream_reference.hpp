// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// A timestamp of every column.
using Line = std::vector<Timestamp>;

/// What happened, clock by clock at the ports: what ERROR and WARNING must say.
struct SubsystemEvents {
  bool underrun = false;
  bool overrun = false;
  bool short_acquisition = false;  ///< tlast came early
  bool long_acquisition = false;   ///< tlast came late
  bool timeout = false;
  bool stalled = false;
  bool aborted = false;

  bool operator==(const SubsystemEvents&) const = default;
};

/// What a subsystem seen from outside must make of its source's lines, as integration.md says: which of them
/// the array gets, and in which place. It holds whole acquisitions, no memory of lines.
class StreamReference {
 public:
  StreamReference(std::size_t acquisition_lines, Timestamp none)
      : acquisition_lines_(acquisition_lines), none_(none) {}

  /// Reset, and what a bench changes between frames.
  void reset();
  void set_release(std::size_t lines) { release_ = lines; }
  /// What the subsystem was built with.
  void set_waits(bool clock_waits, bool source_waits) {
    clock_waits_ = clock_waits;
    source_waits_ = source_waits;
  }
  void set_watchdog(std::uint32_t clocks) { watchdog_ = clocks; }

  /// One clock: what the ports show, in this order.
  /// The array takes `line`; throws RtlError if it must not, or if it is another one.
  void take(const Line& line);
  /// Whether the array waits for an acquisition, and whether the sink refuses a word; throws RtlError if the
  /// array waits although an acquisition is here, or if its clock rests although a line is. A timeout in the
  /// clock of an abort is not told.
  struct Waits {
    bool array_ready;
    bool array_valid;
    bool array_rests;
    bool sink_refuses;
    bool line_stored;
    bool aborts;
  };
  void wait(const Waits& now);
  /// `thrown`: in the clock of an abort or a flush, in which a source that cannot wait goes on.
  void accept(const Line& line, bool last, bool thrown);
  /// The line that comes finds no room in a buffer of so many lines, and its acquisition goes with it.
  void drop(bool last, std::size_t buffer_lines);
  void begin();
  void done();
  void abort();
  void flush();

  /// A line may be refused in this clock although there is room: the watchdog has expired in the last one.
  [[nodiscard]] bool expires() const { return expires_; }
  /// The watchdog has ended the frame for the source in this clock.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  /// The array waits, for an acquisition or for a line inside one.
  [[nodiscard]] bool starved() const { return starved_; }
  /// The array is inside an acquisition.
  [[nodiscard]] bool inside() const { return index_ > 0; }
  /// Lines that wait for the array, and whether this is exact: nothing was thrown away.
  [[nodiscard]] std::size_t waiting() const { return waiting_; }
  [[nodiscard]] bool exact() const { return exact_; }
  /// The source's lines are thrown away up to the next tlast.
  [[nodiscard]] bool hunting() const { return hunting_; }
  /// The source is not to be asked for an acquisition in this clock, behind `wait`.
  [[nodiscard]] bool early() const {
    return clock_waits_ && (rest_ || (source_index_ > 0 ? source_index_ < release_
                                                        : release_ == acquisition_lines_ && !starved_));
  }
  /// Lines of the source's acquisition that have come.
  [[nodiscard]] std::size_t source_index() const { return source_index_; }
  /// Acquisitions in which the buffer ran empty, of the frame.
  [[nodiscard]] std::uint32_t underruns() const { return underruns_; }
  [[nodiscard]] SubsystemEvents& events() { return events_; }
  /// Since reset; the number of lines may be smaller by `doubtful_lines`: an abort came while they were on
  /// their way out.
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

  std::size_t acquisition_lines_;
  Timestamp none_;
  std::size_t release_ = 0;
  bool clock_waits_ = false;
  bool source_waits_ = true;
  std::uint32_t watchdog_ = 0;
  std::deque<Acquisition> acquisitions_;  // the array's first; the last one may not have ended
  std::size_t waiting_ = 0;
  std::size_t source_index_ = 0;
  bool hunting_ = false;
  bool rest_ = false;      // likewise, and neither an abort nor a timeout has ended the acquisition
  bool late_ = false;      // the source's acquisition is one that the array has ended with an underrun
  std::size_t index_ = 0;  // line of the array's acquisition
  bool missing_ = false;   // the rest of it is dark
  bool draining_ = false;  // the rest of the frame is
  bool running_ = false;
  bool starved_ = false;
  bool expires_ = false;
  bool gave_up_ = false;
  bool stalls_ = false;
  std::uint32_t waited_ = 0;
  std::uint32_t withheld_ = 0;  // clocks in which an acquisition was here and not offered
  std::uint32_t refused_ = 0;
  bool exact_ = true;
  std::uint32_t underruns_ = 0;
  SubsystemEvents events_;
  std::uint64_t lost_lines_ = 0;
  std::uint64_t doubtful_lines_ = 0;
  std::uint64_t lost_acquisitions_ = 0;
};

}  // namespace dtof
