// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>

namespace dtof {

/// Makes SIGINT and SIGTERM set the flag that `check_interruption` reads.
void install_interruption_handler();
/// Throws Interrupted after SIGINT or SIGTERM, or once the flag of the thread's StopScope is set.
void check_interruption();

/// For callers with signals of their own, such as Python: while the object lives, setting the flag stops this
/// thread's work, including its `parallel_for`. The flag must outlive the object.
class StopScope {
 public:
  explicit StopScope(const std::atomic<bool>* flag);
  StopScope(const StopScope&) = delete;
  StopScope& operator=(const StopScope&) = delete;
  StopScope(StopScope&&) = delete;
  StopScope& operator=(StopScope&&) = delete;
  ~StopScope();

  /// The thread's flag; null without one.
  static const std::atomic<bool>* flag();

 private:
  const std::atomic<bool>* before_;
};

/// Progress text, e.g. "columns 40 %, 3 min left". The time left assumes constant speed and is omitted in the
/// first second. `done` is at most `total`, which is above 0.
std::string progress_text(std::string_view title, std::size_t done, std::size_t total,
                          std::chrono::duration<double> elapsed);

/// Shows progress on standard error. On a terminal one line is redrawn. Otherwise a line is written at most
/// every `log_interval` of the whole program, so that a log shows that the program is alive. With an
/// observer, nothing is written. Thread-safe.
class Progress {
 public:
  /// Called with the work done and the total work. Calls come from any thread, one at a time.
  using Observer = std::function<void(std::size_t done, std::size_t total)>;

  Progress(std::size_t total, Observer observer);
  Progress(std::string title, std::size_t total,
           std::chrono::steady_clock::duration log_interval = std::chrono::minutes(1));
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;
  /// Erases the progress line on a terminal.
  ~Progress();
  void advance(std::size_t steps = 1);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(std::size_t done, Clock::time_point now);

  std::string title_;
  std::size_t total_;
  Observer observer_;
  Clock::duration log_interval_;
  Clock::time_point start_;
  bool terminal_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
  int drawn_percent_ = -1;
  Clock::time_point drawn_at_;
};

}  // namespace dtof
