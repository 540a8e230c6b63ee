// SPDX-License-Identifier: Apache-2.0
#include "subsystem/axi_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dtof_registers.h"
#include "rtl/error.hpp"

namespace dtof {
namespace {

/// True if the beat ends an aborted frame. In short words the half before the end has a result, or is the
/// end.
bool ends_aborted(std::uint64_t beat, bool short_words) {
  if (!short_words) {
    return beat == DTOF_RESULT_ABORTED_MASK;
  }
  const auto lower = static_cast<std::uint32_t>(beat);
  const auto upper = static_cast<std::uint32_t>(beat >> 32U);
  const bool result = lower != 0 && (lower & DTOF_SHORT_RESULT_ABORTED_MASK) == 0;
  return result ? upper == DTOF_SHORT_RESULT_ABORTED_MASK : beat == DTOF_SHORT_RESULT_ABORTED_MASK;
}

}  // namespace

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
  if (inside_ && valid && !ends_aborted(word, true)) {
    inside_ = false;  // nothing was inside
  }
  const bool aborts = valid && (inside_ || (cut_ && (!held_ || ends_aborted(held_word_, cut_short_))));
  if (aborts && (!ends_aborted(word, inside_ || cut_short_) || first != inside_ || !last)) {
    throw refuse("a frame that was cut off does not end as aborted");
  }
  if (valid && !aborts && first != current_.empty()) {
    throw refuse("tuser is not on the first word");
  }
  if (valid && !inside_ && expected_.empty()) {
    throw refuse("a word although no frame has begun");
  }
  if (valid && !aborts && last != (current_.size() + 1 == expected_.front().beats)) {
    throw refuse("tlast is not on the last word");
  }
  held_ = valid && *ports_.result_ready == 0;
  held_word_ = word;
  held_first_ = first;
  held_last_ = last;
  if (aborts && !held_) {
    ++aborted_;
    current_.push_back(word);
    aborted_words_ = std::move(current_);
    if (!inside_) {
      expected_.pop_front();
    }
    cut_ = false;
    inside_ = false;
    current_.clear();
  } else if (valid && !held_) {
    current_.push_back(word);
    if (last) {
      frames_.push_back(std::move(current_));
      numbers_.push_back(expected_.front().number);
      short_words_.push_back(expected_.front().short_words);
      amplitude_.push_back(expected_.front().amplitude);
      current_.clear();
      expected_.pop_front();
    }
  }
}

bool ResultSink::cut() {
  if (inside_ && held_) {  // the beat that ends a frame stays
    const bool begun = !expected_.empty();
    expected_.clear();
    return begun;
  }
  const bool ends = held_ && held_last_;  // with the word that is offered
  const bool loses = expected_.size() > (cut_ || ends ? 1U : 0U);
  cut_short_ = !expected_.empty() && expected_.front().short_words;
  inside_ = cut_short_ && !held_ && current_.empty();
  cut_ = (cut_ || !ends) && (held_ || !current_.empty());
  while (expected_.size() > (cut_ || ends ? 1U : 0U)) {
    expected_.pop_back();
  }
  return loses;
}

}  // namespace dtof
