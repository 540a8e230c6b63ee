// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <string>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

volatile std::sig_atomic_t interruption_requested = 0;

thread_local const std::atomic<bool>* stop_flag = nullptr;

void request_interruption(int /*signal*/) { interruption_requested = 1; }

/// True once every `interval`, for whichever work asks first.
bool is_time_to_log(std::chrono::steady_clock::time_point now, std::chrono::steady_clock::duration interval) {
  static std::mutex mutex;
  static std::chrono::steady_clock::time_point last = now;  // the first work's first step
  const std::scoped_lock lock(mutex);
  if (now - last < interval) {
    return false;
  }
  last = now;
  return true;
}

/// Progress that nobody can read (standard error is closed or full) is no failure.
void print_to_standard_error(const std::string& text) { std::fputs(text.c_str(), stderr); }

}  // namespace

void install_interruption_handler() {
  std::signal(SIGINT, request_interruption);
  std::signal(SIGTERM, request_interruption);
}

void check_interruption() {
  if (interruption_requested != 0 || (stop_flag != nullptr && *stop_flag)) {
    throw Interrupted();
  }
}

StopScope::StopScope(const std::atomic<bool>* flag) : before_(stop_flag) { stop_flag = flag; }

StopScope::~StopScope() { stop_flag = before_; }

const std::atomic<bool>* StopScope::flag() { return stop_flag; }

std::string progress_text(std::string_view title, std::size_t done, std::size_t total,
                          std::chrono::duration<double> elapsed) {
  const double share = static_cast<double>(done) / static_cast<double>(total);
  std::string text = fmt::format("{} {} %", title, done * 100 / total);
  if (done == 0 || elapsed < std::chrono::seconds(1)) {
    return text;
  }
  const auto seconds = std::llround(elapsed.count() * (1.0 - share) / share);
  constexpr long long kMinute = 60;
  constexpr long long kHour = 60 * kMinute;
  if (seconds < kMinute) {
    return text + fmt::format(", {} s left", seconds);
  }
  if (seconds < kHour) {
    return text + fmt::format(", {} min left", (seconds + kMinute / 2) / kMinute);
  }
  return text + fmt::format(", {} h {} min left", seconds / kHour, seconds % kHour / kMinute);
}

Progress::Progress(std::string title, std::size_t total, std::chrono::steady_clock::duration log_interval)
    : title_(std::move(title)),
      total_(total),
      log_interval_(log_interval),
      start_(Clock::now()),
      terminal_(isatty(STDERR_FILENO) == 1),
      drawn_at_(start_) {}

Progress::Progress(std::size_t total, Observer observer)
    : total_(total),
      observer_(std::move(observer)),
      log_interval_(),
      start_(Clock::now()),
      terminal_(false) {}

Progress::~Progress() {
  if (terminal_ && drawn_percent_ >= 0) {
    print_to_standard_error("\r\033[K");
  }
}

void Progress::advance(std::size_t steps) {
  if (observer_) {
    const std::scoped_lock lock(mutex_);
    observer_(std::min(done_.fetch_add(steps) + steps, total_), total_);
    return;
  }
  const std::size_t done = std::min(done_.fetch_add(steps) + steps, total_);
  if (total_ == 0) {
    return;
  }
  const Clock::time_point now = Clock::now();
  if (terminal_) {
    draw(done, now);
  } else if (is_time_to_log(now, log_interval_)) {
    print_to_standard_error(progress_text(title_, done, total_, now - start_) + "\n");
  }
}

void Progress::draw(std::size_t done, Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  const int percent = static_cast<int>(done * 100 / total_);
  if (percent > drawn_percent_ || now - drawn_at_ >= std::chrono::seconds(1)) {
    drawn_percent_ = percent;
    drawn_at_ = now;
    print_to_standard_error("\r\033[K" + progress_text(title_, done, total_, now - start_));
  }
}

}  // namespace dtof
