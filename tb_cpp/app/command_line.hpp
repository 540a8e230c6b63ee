// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace dtof {

/// The program's commands and options. `command_line` is the whole command line as typed, for reports; it
/// must outlive the parsing.
std::unique_ptr<CLI::App> make_command_line(const std::string& command_line);

/// Parses the arguments (the first is the program's name) and runs the command that they name; help and
/// version are printed. Throws InputError of one line for whatever cannot be parsed.
void run_command_line(CLI::App& app, int count, const char* const* arguments);

}  // namespace dtof
