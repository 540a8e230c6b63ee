// SPDX-License-Identifier: Apache-2.0
#include "commands/json_result.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

namespace dtof {

void JsonResult::add_to(CLI::App& command, bool& wanted) {
  command.add_flag("--json", wanted,
                   "the result as a JSON object on standard output; text for people goes to standard error");
}

JsonResult::JsonResult(bool wanted, const std::string& command, const std::string& command_line) {
  object_["command"] = command;
  object_["command_line"] = command_line;
  if (wanted) {
    output_.emplace();
  }
}

void JsonResult::add_folder(const std::filesystem::path& out) {
  if (!output_) {
    return;
  }
  std::vector<std::string> files;
  // The folder may have other files, some of which cannot be read.
  constexpr auto kOptions = std::filesystem::directory_options::skip_permission_denied;
  std::error_code error;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(out, kOptions)) {
    if (entry.is_regular_file(error)) {
      files.push_back(std::filesystem::relative(entry.path(), out).string());
    }
  }
  std::ranges::sort(files);
  object_["out"] = out.string();
  object_["files"] = files;
}

void JsonResult::finish() {
  if (!output_) {
    return;
  }
  output_.reset();
  // A name of a file may be no UTF-8.
  fmt::print("{}\n", object_.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

nlohmann::ordered_json json_rows(const Table& table) {
  auto rows = nlohmann::ordered_json::array();
  const std::vector<std::vector<std::string>>& cells = table.cells();
  for (std::size_t row = 1; row < cells.size(); ++row) {
    nlohmann::ordered_json object;
    for (std::size_t column = 0; column < cells[row].size(); ++column) {
      object[cells.front()[column]] = cells[row][column];
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

}  // namespace dtof
