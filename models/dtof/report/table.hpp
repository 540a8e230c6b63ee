// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace dtof {

/// A table of text cells. It can be printed as Markdown, aligned for reading on a terminal, and written as
/// CSV.
class Table {
 public:
  /// The first `text_columns` columns hold text, the others figures.
  explicit Table(std::vector<std::string> header, std::size_t text_columns = 1);
  /// Adds a row. Throws std::logic_error unless it has as many cells as the header.
  void add(std::vector<std::string> row);
  /// The table as Markdown: text left-aligned, figures right-aligned. Columns that are too wide for a
  /// terminal are not padded.
  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;
  /// All rows; row 0 is the header.
  [[nodiscard]] const std::vector<std::vector<std::string>>& cells() const { return rows_; }

 private:
  std::size_t text_columns_;
  std::vector<std::vector<std::string>> rows_;  // the header is row 0
};

}  // namespace dtof
