// SPDX-License-Identifier: Apache-2.0
#include "core/progress.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "core/error.hpp"

namespace dtof {
namespace {

volatile std::sig_atomic_t interruption_requested = 0;

void request_interruption(int /*signal*/) { interruption_requested = 1; }

}  // namespace

void install_interruption_handler() {
  std::signal(SIGINT, request_interruption);
  std::signal(SIGTERM, request_interruption);
}

void check_interruption() {
  if (interruption_requested != 0) {
    throw Interrupted();
  }
}

Progress::Progress(std::string title, std::size_t total)
    : title_(std::move(title)), total_(total), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (terminal_ && drawn_percent_ >= 0) {
    fmt::print(stderr, "\r\033[K");
  }
}

void Progress::advance(std::size_t steps) {
  const std::size_t done = done_.fetch_add(steps) + steps;
  if (!terminal_ || total_ == 0) {
    return;
  }
  const std::scoped_lock lock(mutex_);
  const int percent = static_cast<int>(done * 100 / total_);
  if (percent > drawn_percent_) {
    drawn_percent_ = percent;
    fmt::print(stderr, "\r\033[K{} {}%", title_, percent);
  }
}

}  // namespace dtof
