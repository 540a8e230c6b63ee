// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/csv_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = text.find(',');
    parts.push_back(text.substr(0, comma));
    if (comma == std::string_view::npos) {
      return parts;
    }
    text.remove_prefix(comma + 1);
  }
}

void fail_at_line(std::string_view file_name, std::size_t line, std::string_view reason) {
  throw InputError(fmt::format("{}:{}: {}", file_name, line, reason));
}

void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler) {
  const std::vector<std::string_view> names = split_at_commas(header);
  std::vector<std::uint64_t> fields(names.size());
  std::size_t line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    if (line_number == 1) {
      if (line != header) {
        fail_at_line(file_name, 1, fmt::format("the header must be \"{}\"", header));
      }
      continue;
    }
    if (line.empty()) {
      fail_at_line(file_name, line_number, "empty line");
    }
    const char* position = line.data();
    const char* const line_end = line.data() + line.size();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto [next, error] = std::from_chars(position, line_end, fields[i]);
      const bool last = i + 1 == fields.size();
      const bool complete = last ? next == line_end : next != line_end && *next == ',';
      if (error != std::errc() || !complete) {
        const std::vector<std::string_view> parts = split_at_commas(line);
        if (parts.size() != fields.size()) {
          fail_at_line(file_name, line_number,
                       fmt::format("{} fields instead of {} ({})", parts.size(), fields.size(), header));
        }
        fail_at_line(file_name, line_number,
                     error == std::errc::result_out_of_range
                         ? fmt::format("{} \"{}\" is too large", names[i], parts[i])
                         : fmt::format("{} \"{}\" is not a decimal integer", names[i], parts[i]));
      }
      position = last ? next : next + 1;
    }
    handler(line_number, fields);
  }
}

}  // namespace dtof
