// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

/// A CSV of numbers whose first line names the columns and whose first field of every other line names the
/// line.
class CsvTable {
 public:
  /// Reads a file, plain or gzip. Throws InputError "<path>:<line>: <reason>" for a line with another number
  /// of fields than the first one.
  explicit CsvTable(std::filesystem::path path);

  /// Numbers below a column's name. Throws InputError if the file has no column of this name, or if a field
  /// is no number.
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  /// Fields below a column's name, as they are. Throws InputError if the file has no column of this name.
  [[nodiscard]] std::vector<std::string> texts(std::string_view name) const;
  /// Numbers that follow a line's name.
  [[nodiscard]] std::vector<double> row(std::string_view name) const;
  /// Numbers of every line, without the lines' names; lines whose other fields are all empty are left out.
  [[nodiscard]] std::vector<std::vector<double>> rows() const;

 private:
  [[nodiscard]] std::size_t field_of(std::string_view name) const;
  [[nodiscard]] double number(std::size_t line, std::size_t field) const;
  [[nodiscard]] std::vector<double> numbers(std::size_t line) const;

  std::filesystem::path path_;
  std::vector<std::vector<std::string>> lines_;
};

}  // namespace dtof
