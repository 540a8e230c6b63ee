// SPDX-License-Identifier: Apache-2.0
// The command line, one argument a line. The commands themselves do not run.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/command_line.hpp"
#include "core/error.hpp"

namespace {

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
  for (const std::string& argument : arguments) {
    pointers.push_back(argument.c_str());
  }
  const std::string text = "dtof";
  const auto app = dtof::make_command_line(text);
  for (CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; })) {
    command->callback([] {});
  }
  dtof::run_command_line(*app, static_cast<int>(pointers.size()), pointers.data());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    read(data, size);
  } catch (const dtof::InputError&) {  // any other exception ends the fuzzer
  }
  return 0;
}
