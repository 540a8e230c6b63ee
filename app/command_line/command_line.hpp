// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

namespace CLI {
class App;
}

namespace dtof {

/// Texts and commands of one of the project's programs.
struct Program {
  std::string name;
  std::string description;  ///< first lines of --help
  std::string examples;     ///< last lines of --help, before the exit codes
  /// Adds the subcommands, or the options of a program without subcommands; parsing the command line runs
  /// them. `command_line` is the whole command line as
  /// typed, for reports. It must outlive the parsing.
  void (*add_commands)(CLI::App& app, const std::string& command_line);
};

/// Makes the parser of the program's commands and options. `command_line` must outlive the parsing.
std::unique_ptr<CLI::App> make_command_line(const Program& program, const std::string& command_line);

/// Parses the arguments (the first is the program's name) and runs the command; prints help or version if
/// asked for. Throws InputError of one line if the arguments cannot be parsed.
void run_command_line(CLI::App& app, int count, const char* const* arguments);

/// Body of main(): runs the command line, prints an error as one line, and returns the exit code.
int run_program(const Program& program, int count, const char* const* arguments);

}  // namespace dtof
