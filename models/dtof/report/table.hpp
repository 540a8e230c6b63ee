// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace dtof {

/// A small table of text cells that is printed as Markdown (aligned, so that it also reads well on a
/// terminal) and written as CSV.
class Table {
 public:
  /// The first `text_columns` hold text, the others figures.
  explicit Table(std::vector<std::string> header, std::size_t text_columns = 1);
  /// Must have as many cells as the header (std::logic_error).
  void add(std::vector<std::string> row);
  /// Markdown; text is left-aligned, figures right-aligned. Columns too wide for a terminal are not padded.
  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;
  /// The header, then the rows.
  [[nodiscard]] const std::vector<std::vector<std::string>>& cells() const { return rows_; }

 private:
  std::size_t text_columns_;
  std::vector<std::vector<std::string>> rows_;  // the header is row 0
};

}  // namespace dtof
