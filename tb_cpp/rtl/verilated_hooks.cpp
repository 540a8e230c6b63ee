// SPDX-License-Identifier: Apache-2.0
// Verilator's stop, finish, fatal and printing hooks. Its own abort the process; a test program must live on
// and report the message.
#include <fmt/format.h>
#include <verilated.h>

#include <cstdarg>
#include <cstdio>
#include <string>

#include "rtl/error.hpp"
#include "rtl/verilated_printf.h"

namespace {

// The last $error or $fatal text of this thread: Verilator prints it just before it calls vl_stop.
thread_local std::string last_error;

[[noreturn]] void stop(const char* filename, int line, const char* hierarchy, const char* what) {
  std::string message = std::move(last_error);
  last_error.clear();
  if (message.empty()) {
    message = fmt::format("{} at {}:{} in {}", what, filename, line, hierarchy);
  }
  throw dtof::RtlError(message);
}

}  // namespace

void dtof_verilated_printf(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::va_list copy;
  va_copy(copy, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, copy);
  va_end(copy);
  std::string text(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, arguments);
  va_end(arguments);
  const bool is_error = text.find("%Error") != std::string::npos || text.find("%Fatal") != std::string::npos;
  if (is_error) {
    while (!text.empty() && text.back() == '\n') {
      text.pop_back();
    }
    last_error = std::move(text);
  } else {
    std::fputs(text.c_str(), stdout);
  }
}

void vl_stop(const char* filename, int line, const char* hierarchy) {
  // A $error of the RTL is a failed assertion, which a context may have switched off
  // (VerilatedContext::assertOn).
  if (!last_error.empty() && !Verilated::threadContextp()->assertOn()) {
    last_error.clear();
    return;
  }
  stop(filename, line, hierarchy, "$stop");
}
void vl_finish(const char* filename, int line, const char* hierarchy) {
  stop(filename, line, hierarchy, "$finish");
}
void vl_fatal(const char* filename, int line, const char* hierarchy, const char* message) {
  stop(filename, line, hierarchy, message);
}
