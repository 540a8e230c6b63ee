// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

/// A CSV of numbers. The first line names the columns; the first field of every other line names the line.
class CsvTable {
 public:
  /// Reads a file, plain or gzip. Throws InputError "<path>:<line>: <reason>" if a line and the first line
  /// differ in the number of fields.
  explicit CsvTable(std::filesystem::path path);

  /// Numbers of a column. Throws InputError if the file has no column of this name, or if a field is no
  /// number.
  [[nodiscard]] std::vector<double> column(std::string_view name) const;
  /// Unparsed fields of a column. Throws InputError if the file has no column of this name.
  [[nodiscard]] std::vector<std::string> texts(std::string_view name) const;
  /// Numbers of the line with this name.
  [[nodiscard]] std::vector<double> row(std::string_view name) const;
  /// Numbers of all lines, without line names. Lines with only empty fields are left out.
  [[nodiscard]] std::vector<std::vector<double>> rows() const;

 private:
  [[nodiscard]] std::size_t field_of(std::string_view name) const;
  [[nodiscard]] double number(std::size_t line, std::size_t field) const;
  [[nodiscard]] std::vector<double> numbers(std::size_t line) const;

  std::filesystem::path path_;
  std::vector<std::vector<std::string>> lines_;
};

}  // namespace dtof
