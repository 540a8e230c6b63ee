// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/io/csv_fields.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
CsvTable::CsvTable(std::filesystem::path path) : path_(std::move(path)) {
  const std::string contents = read_file_or_gzip(path_);
  std::string_view text = without_byte_order_mark(contents);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    const std::vector<std::string_view> fields = split_at_commas(line);
    lines_.emplace_back(fields.begin(), fields.end());
    if (lines_.back().size() != lines_.front().size()) {
      fail_at_line(
          path_.string(), lines_.size(),
          fmt::format("{} fields, but the first line has {}", lines_.back().size(), lines_.front().size()));
    }
  }
  if (lines_.size() < 2) {
    throw InputError(
        fmt::format("{}: a line of names and at least one of numbers are expected", path_.string()));
  }
}

std::size_t CsvTable::field_of(std::string_view name) const {
  const auto found = std::ranges::find(lines_.front(), name);
  if (found == lines_.front().end()) {
    throw InputError(fmt::format("{}: no column is called '{}'", path_.string(), name));
  }
  return static_cast<std::size_t>(found - lines_.front().begin());
}

std::vector<std::string> CsvTable::texts(std::string_view name) const {
  const std::size_t field = field_of(name);
  std::vector<std::string> values;
  for (std::size_t line = 1; line < lines_.size(); ++line) {
    values.push_back(lines_[line][field]);
  }
  return values;
}

std::vector<double> CsvTable::column(std::string_view name) const {
  const std::size_t field = field_of(name);
  std::vector<double> values;
  for (std::size_t line = 1; line < lines_.size(); ++line) {
    values.push_back(number(line, field));
  }
  return values;
}

std::vector<double> CsvTable::row(std::string_view name) const {
  for (std::size_t line = 1; line < lines_.size(); ++line) {
    if (lines_[line].front() == name) {
      return numbers(line);
    }
  }
  throw InputError(fmt::format("{}: no line begins with '{}'", path_.string(), name));
}

std::vector<std::vector<double>> CsvTable::rows() const {
  std::vector<std::vector<double>> rows;
  for (std::size_t line = 1; line < lines_.size(); ++line) {
    const auto empty = [](const std::string& field) { return field.empty(); };
    if (!std::all_of(lines_[line].begin() + 1, lines_[line].end(), empty)) {
      rows.push_back(numbers(line));
    }
  }
  return rows;
}

double CsvTable::number(std::size_t line, std::size_t field) const {
  const std::string& text = lines_[line][field];
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    fail_at_line(path_.string(), line + 1, fmt::format("'{}' is no number", text));
  }
  return value;
}

std::vector<double> CsvTable::numbers(std::size_t line) const {
  std::vector<double> values;
  for (std::size_t field = 1; field < lines_[line].size(); ++field) {
    values.push_back(number(line, field));
  }
  return values;
}

}  // namespace dtof
