// SPDX-License-Identifier: Apache-2.0
#include "subsystem/axi_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dtof_registers.h"
#include "rtl/error.hpp"

namespace dtof {

void LineSource::drive() {
  offered_ = !waiting_.empty() && (offered_ || (!dead && random_.uniform() >= gap_probability));
  *ports_.line_valid = offered_ ? 1 : 0;
  if (!offered_) {
    // Nobody may look at the line.
    std::generate_n(ports_.line_data, ports_.line_words, [this] { return random_(); });
    *ports_.line_last = static_cast<std::uint8_t>(random_() % 2);
    return;
  }
  std::fill_n(ports_.line_data, ports_.line_words, 0);
  const auto width = static_cast<std::size_t>(np_);
  const Line& line = waiting_.front().line;
  for (std::size_t column = 0; column < line.size(); ++column) {
    const std::size_t bit = column * width;
    const std::uint64_t value = std::uint64_t{line[column]} << (bit % 32);
    ports_.line_data[bit / 32] |= static_cast<std::uint32_t>(value);
    if (bit % 32 + width > 32) {
      ports_.line_data[bit / 32 + 1] |= static_cast<std::uint32_t>(value >> 32U);
    }
  }
  *ports_.line_last = waiting_.front().last ? 1 : 0;
}

const Line* LineSource::observe(bool* last) {
  if (offered_ && impatient && *ports_.line_ready == 0) {
    waiting_.pop_front();
    offered_ = false;
  }
  if (!offered_ || *ports_.line_ready == 0) {
    return nullptr;
  }
  accepted_ = std::move(waiting_.front());
  waiting_.pop_front();
  offered_ = false;
  *last = accepted_.last;
  return &accepted_.line;
}

void ResultSink::drive() { *ports_.result_ready = blocked || random_.uniform() < stall_probability ? 0 : 1; }

void ResultSink::observe() {
  const bool valid = *ports_.result_valid != 0;
  const std::uint64_t word = *ports_.result_data;
  const bool first = *ports_.result_first != 0;
  const bool last = *ports_.result_last != 0;
  const auto refuse = [&](const char* what) {
    return RtlError(fmt::format("results: {}, frame {} word {}", what, frames_.size(), current_.size()));
  };
  if (held_ && !valid) {
    throw refuse("tvalid fell before tready");
  }
  if (held_ && (word != held_word_ || first != held_first_ || last != held_last_)) {
    throw refuse("a word changed before tready");
  }
  const bool aborts = valid && cut_ && (!held_ || held_word_ == DTOF_RESULT_ABORTED_MASK);
  if (aborts && (word != DTOF_RESULT_ABORTED_MASK || first || !last)) {
    throw refuse("a frame that was cut off does not end as aborted");
  }
  if (valid && !aborts && first != current_.empty()) {
    throw refuse("tuser is not on the first word");
  }
  if (valid && expected_.empty()) {
    throw refuse("a word although no frame has begun");
  }
  if (valid && !aborts && last != (current_.size() + 1 == expected_.front().words)) {
    throw refuse("tlast is not on the last word");
  }
  held_ = valid && *ports_.result_ready == 0;
  held_word_ = word;
  held_first_ = first;
  held_last_ = last;
  if (aborts && !held_) {
    ++aborted_;
    cut_ = false;
    current_.clear();
    expected_.pop_front();
  } else if (valid && !held_) {
    current_.push_back(word);
    if (last) {
      frames_.push_back(std::move(current_));
      numbers_.push_back(expected_.front().number);
      current_.clear();
      expected_.pop_front();
    }
  }
}

void ResultSink::cut() {
  const bool ends = held_ && held_last_;  // with the word that is offered
  cut_ = (cut_ || !ends) && (held_ || !current_.empty());
  while (expected_.size() > (cut_ || ends ? 1U : 0U)) {
    expected_.pop_back();
  }
}

}  // namespace dtof
