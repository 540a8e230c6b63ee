// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>

#include "app/command_line.hpp"
#include "core/error.hpp"
#include "core/progress.hpp"
#include "rtl/error.hpp"

namespace {

constexpr int kExitInputError = 1;
constexpr int kExitRtlError = 3;
constexpr int kExitFailure = 4;
constexpr int kExitInterrupted = 130;

std::string join_arguments(int count, char** arguments) {
  std::string line = "dtof";
  for (int i = 1; i < count; ++i) {
    line += ' ';
    line += arguments[i];
  }
  return line;
}

/// A file's name, or what stands in the file, may hold line ends and terminal codes.
std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char letter) { return letter < ' ' || letter == 0x7F; }, ' ');
  return text;
}

int fail(int code, const std::string& reason) {
  fmt::print(stderr, "dtof: error: {}\n", reason);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  dtof::install_interruption_handler();
  try {
    const std::string command_line = join_arguments(argc, argv);
    dtof::run_command_line(*dtof::make_command_line(command_line), argc, argv);
    return 0;
  } catch (const dtof::InputError& error) {
    return fail(kExitInputError, in_one_line(error.what()));
  } catch (const dtof::RtlError& error) {
    return fail(kExitRtlError, error.what());
  } catch (const dtof::Interrupted& error) {
    return fail(kExitInterrupted, error.what());
  } catch (const std::bad_alloc&) {
    return fail(kExitFailure, "the memory of this machine is not enough");
  } catch (const std::exception& error) {
    return fail(kExitFailure, error.what());
  }
}
