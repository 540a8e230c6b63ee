// SPDX-License-Identifier: Apache-2.0
// The command line, one argument a line. The commands themselves do not run.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "command_line/command_line.hpp"
#include "commands/commands.hpp"
#include "common/commands.hpp"
#include "dtof/core/error.hpp"

namespace {

/// The command line is right.
struct Parsed {};

void read(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> arguments = {"dtof", ""};
  for (const char letter : std::string(reinterpret_cast<const char*>(data), size)) {
    if (letter == '\n') {
      arguments.emplace_back();
    } else if (letter != 0) {  // an argument ends there
      arguments.back() += letter;
    }
  }
  std::vector<const char*> pointers;
  pointers.reserve(arguments.size());
  for (const std::string& argument : arguments) {
    pointers.push_back(argument.c_str());
  }
  for (const dtof::Program& program : {dtof::dtof_program(), dtof::study_program()}) {
    const auto app = dtof::make_command_line(program, program.name);
    // A command's callback owns the options, so it stays, but nothing gets so far.
    app->parse_complete_callback([] { throw Parsed(); });
    try {
      dtof::run_command_line(*app, static_cast<int>(pointers.size()), pointers.data());
    } catch (const Parsed&) {
    } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read(data, size);
  return 0;
}
