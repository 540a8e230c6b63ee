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

/// Source of an AXI4-Stream of lines, with random gaps.
class LineSource {
 public:
  LineSource(const SubsystemModel::Ports& ports, int np, CounterRandom random)
      : ports_(ports), np_(np), random_(random) {}

  double gap_probability = 0.0;  ///< probability per clock of no offer
  bool impatient = false;        ///< models a TDC that cannot wait: a refused line is lost
  bool dead = false;             ///< offers no lines

  void push(Line line, bool last) { waiting_.push_back({std::move(line), last}); }
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  void reset() {
    waiting_.clear();
    offered_ = false;
  }

  void drive();
  /// The line accepted in this clock, or null.
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

/// Sink of the result AXI4-Stream. Checks the protocol in every clock: an offered word stays until it is
/// taken, and exactly the first and the last word of a frame are marked.
class ResultSink {
 public:
  ResultSink(const SubsystemModel::Ports& ports, CounterRandom random) : ports_(ports), random_(random) {}

  double stall_probability = 0.0;  ///< probability per clock that tready is low
  bool blocked = false;            ///< tready stays low

  /// Complete frames received, and the words of the current one.
  [[nodiscard]] const std::vector<std::vector<std::uint64_t>>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<std::uint64_t>& current() const { return current_; }
  /// Number of frames that ended with the word for an abort.
  [[nodiscard]] std::size_t aborted() const { return aborted_; }
  /// Words of the last frame that ended so, with its last one.
  [[nodiscard]] const std::vector<std::uint64_t>& aborted_words() const { return aborted_words_; }
  /// True if no word is offered or expected.
  [[nodiscard]] bool idle() const { return expected_.empty() && !held_; }
  /// For each received frame, its number among the expected frames; frames that were cut off without a word
  /// are missing.
  [[nodiscard]] const std::vector<std::size_t>& numbers() const { return numbers_; }
  /// Expects a frame of `words` words after those already expected; with `short_words`, of so many short
  /// words, two in each beat. `amplitude`: words of 64 bits have amplitude and ambient.
  void expect_frame(std::size_t words, bool short_words, bool amplitude) {
    expected_.push_back(
        {begun_++, short_words ? (words + 1) / 2 : words, short_words, amplitude && !short_words});
  }
  /// For each received frame, whether it came in short words.
  [[nodiscard]] const std::vector<bool>& short_words() const { return short_words_; }
  /// For each received frame, whether its words have amplitude and ambient in place of row and column.
  [[nodiscard]] const std::vector<bool>& amplitude() const { return amplitude_; }
  void reset() {
    current_.clear();
    expected_.clear();
    held_ = false;
    cut_ = false;
    inside_ = false;
  }
  /// Cuts off the expected frames after this clock. An offered word stays; a frame whose first words were
  /// sent then ends with the word for an abort. A frame of short words whose first beat was not sent may end
  /// with one beat: its first short word and the one for an abort. Returns true if a frame loses words that
  /// no earlier cut took.
  bool cut();

  void drive();
  /// Throws RtlError if the stream breaks its protocol.
  void observe();

 private:
  SubsystemModel::Ports ports_;
  struct Expected {
    std::size_t number;
    std::size_t beats;
    bool short_words;
    bool amplitude;
  };

  std::deque<Expected> expected_;  // frames to come
  std::size_t begun_ = 0;
  std::vector<std::size_t> numbers_;
  std::vector<bool> short_words_;
  std::vector<bool> amplitude_;
  CounterRandom random_;
  std::vector<std::vector<std::uint64_t>> frames_;
  std::vector<std::uint64_t> current_;
  std::size_t aborted_ = 0;
  std::vector<std::uint64_t> aborted_words_;
  bool cut_ = false;        // the next word, behind one that is held, ends the frame as aborted
  bool cut_short_ = false;  // it is a frame of short words
  bool inside_ = false;     // a frame was cut whose first short word may be in the subsystem, without a beat
  bool held_ = false;       // a word was offered and not taken
  std::uint64_t held_word_ = 0;
  bool held_first_ = false;
  bool held_last_ = false;
};

}  // namespace dtof
