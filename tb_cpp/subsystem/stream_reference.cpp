// SPDX-License-Identifier: Apache-2.0
#include "subsystem/stream_reference.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rtl/error.hpp"

namespace dtof {
namespace {

constexpr std::size_t kOnItsWay = 1;       // lines that were accepted and are not at the buffer's output yet
constexpr std::uint64_t kOnTheWayOut = 2;  // late lines that are not thrown away yet
constexpr std::uint32_t kLongestWay = 8;   // clocks from a line's acceptance to its offer, behind late ones

}  // namespace

void StreamReference::reset() {
  const std::size_t release = release_;
  const std::size_t lines = acquisition_lines_;
  const Build build = build_;
  *this = StreamReference(lines, none_);
  release_ = release;
  build_ = build;
}

bool StreamReference::dark(const Line& line) const {
  return std::ranges::all_of(line, [this](Timestamp timestamp) { return timestamp == none_; });
}

void StreamReference::take(const Line& line) {
  const auto refuse = [&](const char* what) {
    return RtlError(fmt::format("line {} of an acquisition {}, {} wait", index_, what, waiting_));
  };
  if (draining_) {
    if (!dark(line)) {
      throw refuse("behind a timeout is not dark");
    }
    missing_ = true;
  } else {
    if (acquisitions_.empty()) {
      throw refuse("comes from nowhere");
    }
    Acquisition& acquisition = acquisitions_.front();
    if (index_ == 0 && !acquisition.ended && !build_.clock_waits && waiting_ < offered_from()) {
      throw refuse("is offered too early");
    }
    const bool here = index_ < acquisition.lines.size();
    if (!missing_ && here && line == acquisition.lines[index_]) {
      --waiting_;
    } else if (!dark(line)) {
      throw refuse("is not the source's");
    } else if (!missing_ && !here && acquisition.ended) {
      missing_ = true;
    } else if (!missing_) {
      if (build_.clock_waits) {
        throw refuse("is not waited for");
      }
      if (index_ == 0 || acquisition.lines.size() > index_ + kOnItsWay) {
        throw refuse("is dark although it is here");
      }
      missing_ = true;
      events_.underrun = true;
      ++underruns_;
      lost_lines_ += acquisition.lines.size() - index_;
      waiting_ -= acquisition.lines.size() - index_;
      late_ = !acquisition.ended;
      exact_ = false;
      acquisition.ended = true;
      acquisition.lines.resize(index_);
    }
  }
  if (++index_ == acquisition_lines_) {
    lost_acquisitions_ += missing_ ? 1 : 0;
    if (!draining_) {
      acquisitions_.pop_front();
    }
    index_ = 0;
    missing_ = false;
  }
}

void StreamReference::expect_rest(bool here) const {
  if (!build_.clock_waits || index_ == 0 || missing_ || draining_) {
    throw RtlError("the array's clock rests although no line is late");
  }
  if (here && waiting_ > kOnItsWay) {
    throw RtlError(fmt::format("the array's clock rests although {} lines are here", waiting_));
  }
}

void StreamReference::wait(const Waits& now) {
  const bool aborts = now.aborts;
  if (now.array_rests) {
    expect_rest(!acquisitions_.empty() && acquisitions_.front().lines.size() > index_);
  }
  starved_ = ((starved_ || now.array_ready) && !now.array_valid) || (now.array_rests && waiting_ == 0);
  const bool here =
      !acquisitions_.empty() &&
      (now.array_rests ? acquisitions_.front().ended || acquisitions_.front().lines.size() > index_
                       : acquisitions_.front().ended || build_.clock_waits || waiting_ >= offered_from());
  withheld_ = (starved_ || now.array_rests) && here ? withheld_ + 1 : 0;
  if (withheld_ > kLongestWay) {
    throw RtlError(fmt::format("an acquisition is here and not offered, {} lines wait", waiting_));
  }
  gave_up_ = expires_ && starved_ && running_;
  if (gave_up_) {
    events_.timeout = events_.timeout || !aborts;
    lost_lines_ += waiting_;
    hunting_ = hunting_ || source_index_ > 0;
    rest_ = false;
    empty();
    draining_ = true;
  }
  expires_ = false;
  waited_ = watchdog_ > 0 && waits_ ? waited_ + 1 : 0;
  waits_ = starved_ && running_ && !(now.line_stored && !hunting_);
  if (watchdog_ > 0 && waited_ >= watchdog_) {
    expires_ = true;
    waited_ = 0;
  }
  events_.stalled = events_.stalled || stalls_;
  refused_ = watchdog_ > 0 && sink_refused_ ? refused_ + 1 : 0;
  sink_refused_ = now.sink_refuses;
  stalls_ = watchdog_ > 0 && refused_ >= watchdog_;
  refused_ = stalls_ ? 0 : refused_;
}

void StreamReference::drop(bool last) {
  const bool begun = source_index_ > 0 && !draining_ && index_ > 0 && acquisitions_.size() == 1;
  if (build_.source_waits || hunting_ || begun || waiting_ + 1 < build_.buffer_lines) {
    throw RtlError(
        fmt::format("an acquisition is dropped, {} of {} lines wait", waiting_, build_.buffer_lines));
  }
  lost_lines_ += source_index_ + 1;
  ++lost_acquisitions_;
  waiting_ -= source_index_;
  if (source_index_ > 0) {
    acquisitions_.pop_back();
  }
  source_index_ = 0;
  hunting_ = !last;
  rest_ = !last;
}

void StreamReference::accept(const Line& line, bool last, bool thrown) {
  if (hunting_ || thrown || gave_up_) {
    lost_lines_ += hunting_ || gave_up_ ? 1 : 0;
    hunting_ = !last;
    rest_ = rest_ && !last;
    if (thrown) {
      source_index_ = 0;
    }
    return;
  }
  ++source_index_;
  const bool full = source_index_ == acquisition_lines_;
  if (late_) {
    ++lost_lines_;
  } else {
    if (source_index_ == 1) {
      acquisitions_.emplace_back();
    }
    acquisitions_.back().lines.push_back(line);
    acquisitions_.back().ended = full || last;
    ++waiting_;
  }
  events_.short_acquisition = events_.short_acquisition || (last && !full);
  events_.long_acquisition = events_.long_acquisition || (full && !last);
  if (full || last) {
    hunting_ = !last;
    rest_ = !last;
    late_ = false;
    source_index_ = 0;
  }
}

void StreamReference::begin() {
  running_ = true;
  underruns_ = 0;
}

void StreamReference::done() {
  running_ = false;
  draining_ = false;
}

void StreamReference::empty() {
  acquisitions_.clear();
  waiting_ = 0;
  source_index_ = 0;
  late_ = false;
  exact_ = true;
}

void StreamReference::abort() {
  events_.aborted = events_.aborted || running_;
  doubtful_lines_ += exact_ ? 0 : kOnTheWayOut;
  hunting_ = hunting_ || source_index_ > 0;
  rest_ = false;
  empty();
  index_ = 0;
  missing_ = false;
  draining_ = false;
  running_ = false;
  starved_ = false;
}

void StreamReference::flush() {
  doubtful_lines_ += exact_ ? 0 : kOnTheWayOut;
  empty();
  hunting_ = false;
  rest_ = false;
}

}  // namespace dtof
