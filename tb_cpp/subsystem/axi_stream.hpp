// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "dtof/core/random.hpp"
#include "rtl/configuration.hpp"
#include "subsystem/stream_reference.hpp"
#include "subsystem/subsystem_model.hpp"

namespace dtof {

/// Source of an AXI4-Stream of lines with gaps anywhere.
class LineSource {
 public:
  LineSource(const SubsystemModel::Ports& ports, int np, CounterRandom random)
      : ports_(ports), np_(np), random_(random) {}

  double gap_probability = 0.0;  ///< per clock without a line offered
  bool impatient = false;        ///< a TDC that cannot wait: a line that is refused is gone
  bool dead = false;             ///< offers nothing

  void push(Line line, bool last) { waiting_.push_back({std::move(line), last}); }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  void reset() {
    waiting_.clear();
    offered_ = false;
  }

  void drive();
  /// The line that was accepted in this clock, or null.
  [[nodiscard]] const Line* observe(bool* last);

 private:
  struct Entry {
    Line line;
    bool last;
  };

  SubsystemModel::Ports ports_;
  int np_;
  CounterRandom random_;
  std::deque<Entry> waiting_;
  Entry accepted_{};
  bool offered_ = false;
};

/// Sink of the results' AXI4-Stream that checks the protocol in every clock: what is offered stays until it
/// is taken; the first and the last word of a frame are marked, and no others.
class ResultSink {
 public:
  ResultSink(const SubsystemModel::Ports& ports, CounterRandom random) : ports_(ports), random_(random) {}

  double stall_probability = 0.0;  ///< per clock
  bool blocked = false;            ///< takes nothing

  /// Frames that were received whole, and the words of the one that is under way.
  [[nodiscard]] const std::vector<std::vector<std::uint64_t>>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<std::uint64_t>& current() const { return current_; }
  /// Frames that ended with a word that says that they were aborted.
  [[nodiscard]] std::size_t aborted() const { return aborted_; }
  /// Nothing is offered or expected.
  [[nodiscard]] bool idle() const { return expected_.empty() && !held_; }
  /// Which of the frames that were expected these are: those that were cut off are missing.
  [[nodiscard]] const std::vector<std::size_t>& numbers() const { return numbers_; }
  /// A frame of so many words begins, behind those that are still expected.
  void expect_frame(std::size_t words) { expected_.push_back({begun_++, words}); }
  void reset() {
    current_.clear();
    expected_.clear();
    held_ = false;
    cut_ = false;
  }
  /// The frames that have begun are cut off behind this clock: what is offered stays, then a frame whose
  /// first words have come ends with the word that says so.
  void cut();

  void drive();
  /// Throws RtlError if the stream breaks its protocol.
  void observe();

 private:
  SubsystemModel::Ports ports_;
  struct Expected {
    std::size_t number;
    std::size_t words;
  };

  std::deque<Expected> expected_;  // frames to come
  std::size_t begun_ = 0;
  std::vector<std::size_t> numbers_;
  CounterRandom random_;
  std::vector<std::vector<std::uint64_t>> frames_;
  std::vector<std::uint64_t> current_;
  std::size_t aborted_ = 0;
  bool cut_ = false;   // the next word, behind one that is held, ends the frame as aborted
  bool held_ = false;  // a word was offered and not taken
  std::uint64_t held_word_ = 0;
  bool held_first_ = false;
  bool held_last_ = false;
};

}  // namespace dtof
