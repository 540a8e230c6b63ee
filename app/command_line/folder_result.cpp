// SPDX-License-Identifier: Apache-2.0
#include "command_line/folder_result.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "command_line/standard_streams.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

using Json = nlohmann::ordered_json;

/// Fields of the line at the beginning of `text`, which the call takes away. A field in quotation marks may
/// hold commas, line ends, and a quotation mark twice for one.
std::vector<std::string> take_line(std::string_view& text) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  std::size_t at = 0;
  for (; at < text.size() && (quoted || text[at] != '\n'); ++at) {
    const char letter = text[at];
    if (letter == '"' && quoted && text.substr(at + 1).starts_with('"')) {
      fields.back() += text[++at];
    } else if (letter == '"') {
      quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      fields.emplace_back();
    } else if (letter != '\r' || quoted) {
      fields.back() += letter;
    }
  }
  text.remove_prefix(std::min(at + 1, text.size()));
  return fields;
}

Json value_of(const std::string& field) {
  if (field.empty()) {
    return nullptr;
  }
  const char* const end = field.data() + field.size();
  long long whole = 0;
  if (const auto [stop, error] = std::from_chars(field.data(), end, whole);
      error == std::errc() && stop == end) {
    return whole;
  }
  double number = 0.0;
  if (const auto [stop, error] = std::from_chars(field.data(), end, number);
      error == std::errc() && stop == end && std::isfinite(number)) {
    return number;
  }
  return field;
}

/// Standard output of a command: redirected to standard error until the object is printed.
class FolderResult {
 public:
  void print(const std::string& command, const std::string& command_line, const std::filesystem::path& out) {
    Json object;
    object["command"] = command;
    object["command_line"] = command_line;
    object["out"] = out.string();
    object["files"] = Json::array();
    object["tables"] = Json::object();
    for (const std::filesystem::path& file : written(out)) {
      const std::string name = std::filesystem::relative(file, out).string();
      object["files"].push_back(name);
      if (file.extension() == ".csv") {
        object["tables"][name] = csv_rows(read_file(file));
      }
    }
    output_.restore();
    // A name of a file may be no UTF-8.
    fmt::print("{}\n", object.dump(2, ' ', false, Json::error_handler_t::replace));
  }

 private:
  [[nodiscard]] std::vector<std::filesystem::path> written(const std::filesystem::path& out) const {
    std::vector<std::filesystem::path> files;
    if (std::filesystem::is_directory(out)) {
      // The folder may have other files, some of which cannot be read.
      constexpr auto kOptions = std::filesystem::directory_options::skip_permission_denied;
      std::error_code error;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(out, kOptions)) {
        if (entry.is_regular_file(error) && entry.last_write_time(error) >= begin_) {
          files.push_back(entry.path());
        }
      }
    }
    std::ranges::sort(files);
    return files;
  }

  RedirectedOutput output_;
  /// A file's time may be some milliseconds older than the clock.
  std::filesystem::file_time_type begin_ =
      std::filesystem::file_time_type::clock::now() - std::chrono::milliseconds(20);
};

}  // namespace

nlohmann::ordered_json csv_rows(std::string_view text) {
  Json rows = Json::array();
  const std::vector<std::string> names = take_line(text);
  while (!text.empty()) {
    const std::vector<std::string> fields = take_line(text);
    Json row = Json::object();
    for (std::size_t column = 0; column < std::min(names.size(), fields.size()); ++column) {
      row[names[column]] = value_of(fields[column]);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

void add_folder_results(CLI::App& app, const std::string& command_line, const std::function<void()>& run) {
  constexpr const char* kJson = "--json";
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    command->add_flag(kJson)->description(
        "the tables as a JSON object on standard output; text for people goes to standard error");
  }
  const auto result = std::make_shared<std::unique_ptr<FolderResult>>();
  const auto chosen = [&app] {
    const std::vector<CLI::App*> parsed = app.get_subcommands();
    return parsed.empty() ? &app : parsed.front();
  };
  // Before the command's own callback, and after.
  app.parse_complete_callback([result, chosen, kJson] {
    if (chosen()->count(kJson) > 0) {
      *result = std::make_unique<FolderResult>();
    }
  });
  app.final_callback([result, chosen, &command_line, run] {
    if (run) {
      run();
    }
    if (*result) {
      const CLI::App& command = *chosen();
      (*result)->print(command.get_name(), command_line, command.get_option("--out")->as<std::string>());
      result->reset();
    }
  });
}

}  // namespace dtof
