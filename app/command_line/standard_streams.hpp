// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace dtof {

/// Lets SIGINT and SIGTERM end a call that waits, for instance for the bytes of a pipe. Their handler
/// (core/progress.hpp) alone would let the call go on.
void let_signals_end_waiting();

/// Opens substitutes for closed standard streams, so that no other file gets their numbers. Text for standard
/// error is then dropped; writing to standard output fails.
void open_closed_streams();

/// Flushes standard output. Returns why not all output was written; empty if it was.
std::string flush_standard_output();

/// While this object lives, or until restore(), what goes to standard output goes to standard error.
class RedirectedOutput {
 public:
  RedirectedOutput();
  RedirectedOutput(const RedirectedOutput&) = delete;
  RedirectedOutput& operator=(const RedirectedOutput&) = delete;
  RedirectedOutput(RedirectedOutput&&) = delete;
  RedirectedOutput& operator=(RedirectedOutput&&) = delete;
  ~RedirectedOutput();

  /// Flushes what was written so far, and gives standard output back.
  void restore();

 private:
  int standard_output_;  ///< -1: standard output is given back
};

/// Writes a line to standard error; ignores errors.
void print_error_line(const std::string& line) noexcept;

}  // namespace dtof
