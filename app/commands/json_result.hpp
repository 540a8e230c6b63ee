// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "command_line/standard_streams.hpp"
#include "dtof/report/table.hpp"

namespace CLI {
class App;
}

namespace dtof {

/// Result of a command as one JSON object on standard output (`--json`). Until finish(), text for people is
/// redirected to standard error. Without --json the object does nothing.
class JsonResult {
 public:
  /// Adds the option --json to a command.
  static void add_to(CLI::App& command, bool& wanted);

  /// `command_line`: as typed.
  JsonResult(bool wanted, const std::string& command, const std::string& command_line);

  /// Member of the JSON object.
  nlohmann::ordered_json& operator[](const char* key) { return object_[key]; }
  /// Adds `out`, and `files`: the sorted names of the files in it, those in its folders with their path.
  void add_folder(const std::filesystem::path& out);
  /// Prints the object. A command that fails before prints none.
  void finish();

 private:
  std::optional<RedirectedOutput> output_;  ///< none: --json was not given, or the object is printed
  nlohmann::ordered_json object_;
};

/// Rows of a table as objects, with a member per column named by its header.
nlohmann::ordered_json json_rows(const Table& table);

}  // namespace dtof
