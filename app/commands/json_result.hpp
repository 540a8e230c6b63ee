// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "dtof/report/table.hpp"

namespace CLI {
class App;
}

namespace dtof {

/// The result of a command as one JSON object on standard output (`--json`). What the command prints for
/// people goes to standard error meanwhile. Without --json it does nothing.
class JsonResult {
 public:
  /// The option of a command.
  static void add_to(CLI::App& command, bool& wanted);

  /// `command_line` as typed.
  JsonResult(bool wanted, const std::string& command, const std::string& command_line);
  JsonResult(const JsonResult&) = delete;
  JsonResult& operator=(const JsonResult&) = delete;
  JsonResult(JsonResult&&) = delete;
  JsonResult& operator=(JsonResult&&) = delete;
  /// Standard output is the program's own again; a command that failed has no object.
  ~JsonResult();

  /// A member of the object.
  nlohmann::ordered_json& operator[](const char* key) { return object_[key]; }
  /// `out`, and `files`, the names of the files in it, sorted; of folders in it those with their folder.
  void add_folder(const std::filesystem::path& out);
  /// Prints the object.
  void finish();

 private:
  int standard_output_ = -1;  ///< -1: JSON is not asked for, or printed
  nlohmann::ordered_json object_;
};

/// The rows as objects: a member for each column, by its head.
nlohmann::ordered_json json_rows(const Table& table);

}  // namespace dtof
