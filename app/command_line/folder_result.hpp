// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace dtof {

/// Rows of a CSV table as objects, with a member per column named by the first line. A field that is a finite
/// number becomes a number, an empty field becomes null, any other field stays a text.
nlohmann::ordered_json csv_rows(std::string_view text);

/// Adds --json to every command of a program. With --json, text for people goes to standard error, and one
/// JSON object on standard output follows: `command`, `command_line`, `out` (the folder of the option --out),
/// `files` (those that the command wrote there), and `tables` (rows of the CSV files among them). A command
/// that fails prints no object. `run` is the work of a program without commands. `command_line` must outlive
/// the parsing.
void add_folder_results(CLI::App& app, const std::string& command_line,
                        const std::function<void()>& run = nullptr);

}  // namespace dtof
