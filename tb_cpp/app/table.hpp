// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dtof {

/// A small table of text cells that is printed as Markdown (aligned, so that it also reads well on a
/// terminal) and written as CSV.
class Table {
 public:
  explicit Table(std::vector<std::string> header);
  /// Must have as many cells as the header (std::logic_error).
  void add(std::vector<std::string> row);
  /// Markdown; the first column is left-aligned, the others right-aligned.
  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] std::string csv() const;

 private:
  std::vector<std::vector<std::string>> rows_;  // the header is row 0
};

}  // namespace dtof
