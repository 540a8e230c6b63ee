// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <string>

namespace dtof {

/// Makes SIGINT and SIGTERM set a flag that `check_interruption` turns into an exception.
void install_interruption_handler();
/// Throws Interrupted after SIGINT or SIGTERM.
void check_interruption();

/// One progress line on standard error, drawn only on a terminal. Thread-safe.
class Progress {
 public:
  Progress(std::string title, std::size_t total);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  Progress(Progress&&) = delete;
  Progress& operator=(Progress&&) = delete;
  /// Erases the line.
  ~Progress();
  void advance(std::size_t steps = 1);

 private:
  std::string title_;
  std::size_t total_;
  bool terminal_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
  int drawn_percent_ = -1;
};

}  // namespace dtof
