// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/csv_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/input_file.hpp"

namespace dtof {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) {
      return parts;
    }
    text.remove_prefix(end + 1);
  }
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == std::string_view::npos ? ""
                                         : text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// What stands in a field, without blanks and quotation marks around it.
std::string_view bare(std::string_view field) {
  field = without_blanks(field);
  return field.size() >= 2 && field.front() == '"' && field.back() == '"'
             ? without_blanks(field.substr(1, field.size() - 2))
             : field;
}

/// The separator with which a first line names these fields; 0 if neither does.
char separator_of(std::string_view line, std::span<const std::string_view> names) {
  for (const char separator : {',', ';'}) {
    const std::vector<std::string_view> parts = split(line, separator);
    if (std::ranges::equal(parts, names, {}, bare)) {
      return separator;
    }
  }
  return '\0';
}

/// The rules of one file, for lines that are not plainly digits and commas.
struct LineReader {
  std::string_view file_name;
  std::string_view header;
  std::span<const std::string_view> names;
  char separator;
  std::string_view may_be_none;

  [[noreturn]] void refuse(std::size_t line, std::size_t field, std::string_view text,
                           const char* what) const {
    fail_at_line(file_name, line, fmt::format("{} \"{}\" is {}", names[field], text, what));
  }

  void read(std::size_t line_number, std::string_view line, std::span<std::uint64_t> fields) const {
    const std::vector<std::string_view> parts = split(line, separator);
    if (parts.size() != fields.size()) {
      fail_at_line(file_name, line_number,
                   fmt::format("{} fields instead of {} ({})", parts.size(), fields.size(), header));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      fields[i] = value(line_number, i, parts[i]);
    }
  }

 private:
  [[nodiscard]] std::uint64_t value(std::size_t line, std::size_t field, std::string_view text) const {
    constexpr const char* kNoInteger = "not a decimal integer";
    std::string_view digits = bare(text);
    const bool negative = digits.starts_with('-');
    digits.remove_prefix(negative ? 1 : 0);
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error == std::errc::result_out_of_range || (error == std::errc() && number == kNoCsvValue)) {
      refuse(line, field, text, "too large");
    }
    // With semicolons between the fields a comma may stand before the fraction.
    std::string_view rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
    if (rest.starts_with('.') || (separator == ';' && rest.starts_with(','))) {
      rest = rest.find_first_not_of('0', 1) == std::string_view::npos ? "" : rest;
    }
    if (error != std::errc() || !rest.empty()) {
      refuse(line, field, text, kNoInteger);
    }
    if (!negative) {
      return number;
    }
    if (number != 1 || names[field] != may_be_none) {
      refuse(line, field, text, kNoInteger);
    }
    return kNoCsvValue;
  }
};

/// Reads a line of nothing but digits and separators, and no number that is kNoCsvValue; false for any other.
bool read_plain(std::string_view line, char separator, std::span<std::uint64_t> fields) {
  const char* position = line.data();
  const char* const line_end = line.data() + line.size();
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto [next, error] = std::from_chars(position, line_end, fields[i]);
    const bool last = i + 1 == fields.size();
    if (error != std::errc() || fields[i] == kNoCsvValue ||
        (last ? next != line_end : next == line_end || *next != separator)) {
      return false;
    }
    position = last ? next : next + 1;
  }
  return true;
}

}  // namespace

std::vector<std::string_view> split_at_commas(std::string_view text) { return split(text, ','); }

void fail_at_line(std::string_view file_name, std::size_t line, std::string_view reason) {
  throw InputError(fmt::format("{}:{}: {}", file_name, line, reason));
}

void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler, std::string_view may_be_none) {
  text = without_byte_order_mark(text);
  const std::vector<std::string_view> names = split_at_commas(header);
  std::vector<std::uint64_t> fields(names.size());
  LineReader reader{file_name, header, names, ',', may_be_none};
  std::size_t line_number = 0;
  std::size_t empty_line = 0;  // the first one behind the last line that is not
  while (!text.empty()) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    if (line_number == 1) {
      reader.separator = separator_of(line, names);
      if (reader.separator == '\0') {
        fail_at_line(file_name, 1, fmt::format("the header must be \"{}\"", header));
      }
      continue;
    }
    if (without_blanks(line).empty()) {
      empty_line = empty_line == 0 ? line_number : empty_line;
      continue;
    }
    if (empty_line != 0) {
      fail_at_line(file_name, empty_line, "empty line");
    }
    if (!read_plain(line, reader.separator, fields)) {
      reader.read(line_number, line, fields);
    }
    handler(line_number, fields);
  }
}

}  // namespace dtof
