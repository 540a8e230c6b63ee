// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace dtof {

/// Splits a line at its commas.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// Value of a field that holds -1, where -1 is legal and means "no value".
inline constexpr std::uint64_t kNoCsvValue = std::numeric_limits<std::uint64_t>::max();

/// Called for each data line with its number (the header is line 1) and its fields.
using CsvLineHandler = std::function<void(std::size_t line, std::span<const std::uint64_t> fields)>;

/// A CSV of unsigned decimal integers, taken line by line. `header`, the first line, gives the number and the
/// names of the fields. Field `may_be_none` may hold -1 (kNoCsvValue).
///
/// Accepted variants: semicolons instead of commas in the whole file; blanks or quotation marks around a
/// field; a fraction of zeros (100.0); empty lines at the end.
class IntegerCsv {
 public:
  /// `header` and `may_be_none` must outlive the object.
  IntegerCsv(std::string file_name, std::string_view header, CsvLineHandler handler,
             std::string_view may_be_none = "");

  /// Takes the next line, without its end. Throws InputError "<file>:<line>: <reason>" for a malformed line.
  void take(std::string_view line);

 private:
  [[noreturn]] void refuse(std::size_t field, std::string_view text, const char* what) const;
  void read_fields(std::string_view line);
  [[nodiscard]] std::uint64_t value(std::size_t field, std::string_view text) const;

  std::string file_name_;
  std::string_view header_;
  CsvLineHandler handler_;
  std::string_view may_be_none_;
  std::vector<std::string_view> names_;
  std::vector<std::uint64_t> fields_;
  char separator_ = ',';
  std::size_t line_number_ = 0;
  std::size_t empty_line_ = 0;  ///< the first one behind the last line that is not
};

/// Takes all lines of `text` (IntegerCsv), whose lines end with LF or CRLF. Skips a leading byte order mark.
void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler, std::string_view may_be_none = "");

/// Throws InputError "<file>:<line>: <reason>".
[[noreturn]] void fail_at_line(std::string_view file_name, std::size_t line, std::string_view reason);

}  // namespace dtof
