// SPDX-License-Identifier: Apache-2.0
#include "command_line/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

namespace dtof {

void open_closed_streams() {
  // open() gives the lowest number that is free.
  constexpr std::array<int, 3> kModes = {O_WRONLY, O_RDONLY, O_WRONLY};  // input and output: of no use
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) {
      (void)::open("/dev/null",
                   kModes.at(static_cast<std::size_t>(descriptor)));  // NOLINT(android-cloexec-open)
    }
  }
}

void let_signals_end_waiting() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) == 0) {
      action.sa_flags &= ~SA_RESTART;
      (void)::sigaction(signal, &action, nullptr);
    }
  }
}

std::string flush_standard_output() {
  const bool failed = std::ferror(stdout) != 0;
  if (std::fflush(stdout) != 0) {
    return std::generic_category().message(errno);
  }
  return failed ? "some of it could not be written" : "";
}

RedirectedOutput::RedirectedOutput() {
  std::fflush(stdout);
  standard_output_ = ::dup(STDOUT_FILENO);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

RedirectedOutput::~RedirectedOutput() { restore(); }

void RedirectedOutput::restore() {
  if (standard_output_ >= 0) {
    std::fflush(stdout);
    ::dup2(standard_output_, STDOUT_FILENO);
    ::close(std::exchange(standard_output_, -1));
  }
}

void print_error_line(const std::string& line) noexcept {
  std::fputs(line.c_str(), stderr);
  std::fputs("\n", stderr);
}

}  // namespace dtof
