// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace dtof::test {

/// Result of a command.
struct Outcome {
  int exit_code;       ///< -1 if a signal ended the command
  std::string output;  ///< standard output and standard error
};

/// Runs `command` in a shell of its own.
inline Outcome run_shell(const std::string& command) {
  std::FILE* const pipe = popen(("( " + command + " ) 2>&1").c_str(), "r");
  if (pipe == nullptr) {
    return {-1, "no shell could be started"};
  }
  Outcome outcome{-1, ""};
  std::array<char, 4096> part{};
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe)) {
    outcome.output.append(part.data(), count);
  }
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace dtof::test
