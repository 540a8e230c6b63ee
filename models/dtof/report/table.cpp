// SPDX-License-Identifier: Apache-2.0
#include "dtof/report/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace dtof {
namespace {

/// In quotation marks where it has a comma or one of them (RFC 4180).
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char letter : text) {
    quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  }
  return quoted + '"';
}

}  // namespace

Table::Table(std::vector<std::string> header, std::size_t text_columns) : text_columns_(text_columns) {
  rows_.push_back(std::move(header));
}

void Table::add(std::vector<std::string> row) {
  if (row.size() != rows_.front().size()) {
    throw std::logic_error("table row and header differ in length");
  }
  rows_.push_back(std::move(row));
}

std::string Table::markdown() const {
  const std::size_t columns = rows_.front().size();
  std::vector<std::size_t> width(columns, 3);
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < columns; ++c) {
      width[c] = std::max(width[c], row[c].size());
    }
  }
  constexpr std::size_t kWidest = 60;
  std::ranges::replace_if(
      width, [](std::size_t w) { return w > kWidest; }, 3);
  std::string text;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    text += '|';
    for (std::size_t c = 0; c < columns; ++c) {
      text += c < text_columns_ ? fmt::format(" {:<{}} |", rows_[r][c], width[c])
                                : fmt::format(" {:>{}} |", rows_[r][c], width[c]);
    }
    text += '\n';
    if (r == 0) {
      text += '|';
      for (std::size_t c = 0; c < columns; ++c) {
        text += c < text_columns_ ? fmt::format("{:-<{}}|", "", width[c] + 2)
                                  : fmt::format("{:-<{}}:|", "", width[c] + 1);
      }
      text += '\n';
    }
  }
  return text;
}

std::string Table::csv() const {
  std::string text;
  for (const auto& row : rows_) {
    std::vector<std::string> fields;
    std::ranges::transform(row, std::back_inserter(fields), csv_field);
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

}  // namespace dtof
