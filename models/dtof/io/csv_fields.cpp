// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/csv_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <system_error>
#include <utility>
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
  throw InputError(fmt::format("{}:{}: {}", file_name, line, with_visible_nul(reason)));
}

IntegerCsv::IntegerCsv(std::string file_name, std::string_view header, CsvLineHandler handler,
                       std::string_view may_be_none)
    : file_name_(std::move(file_name)),
      header_(header),
      handler_(std::move(handler)),
      may_be_none_(may_be_none),
      names_(split_at_commas(header)),
      fields_(names_.size()) {}

void IntegerCsv::take(std::string_view line) {
  ++line_number_;
  if (line_number_ == 1) {
    separator_ = separator_of(line, names_);
    if (separator_ == '\0') {
      fail_at_line(file_name_, 1, fmt::format("the header must be \"{}\"", header_));
    }
    return;
  }
  if (without_blanks(line).empty()) {
    empty_line_ = empty_line_ == 0 ? line_number_ : empty_line_;
    return;
  }
  if (empty_line_ != 0) {
    fail_at_line(file_name_, empty_line_, "empty line");
  }
  if (!read_plain(line, separator_, fields_)) {
    read_fields(line);
  }
  handler_(line_number_, fields_);
}

void IntegerCsv::refuse(std::size_t field, std::string_view text, const char* what) const {
  fail_at_line(file_name_, line_number_, fmt::format("{} \"{}\" is {}", names_[field], text, what));
}

void IntegerCsv::read_fields(std::string_view line) {
  const std::vector<std::string_view> parts = split(line, separator_);
  if (parts.size() != fields_.size()) {
    fail_at_line(file_name_, line_number_,
                 fmt::format("{} fields instead of {} ({})", parts.size(), fields_.size(), header_));
  }
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    fields_[i] = value(i, parts[i]);
  }
}

std::uint64_t IntegerCsv::value(std::size_t field, std::string_view text) const {
  constexpr const char* kNoInteger = "not a decimal integer";
  std::string_view digits = bare(text);
  const bool negative = digits.starts_with('-');
  digits.remove_prefix(negative ? 1 : 0);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc::result_out_of_range || (error == std::errc() && number == kNoCsvValue)) {
    refuse(field, text, "too large");
  }
  // With semicolons between the fields a comma may stand before the fraction.
  std::string_view rest = digits.substr(static_cast<std::size_t>(end - digits.data()));
  if (rest.starts_with('.') || (separator_ == ';' && rest.starts_with(','))) {
    rest = rest.find_first_not_of('0', 1) == std::string_view::npos ? "" : rest;
  }
  if (error != std::errc() || !rest.empty()) {
    refuse(field, text, kNoInteger);
  }
  if (!negative) {
    return number;
  }
  if (number != 1 || names_[field] != may_be_none_) {
    refuse(field, text, kNoInteger);
  }
  return kNoCsvValue;
}

void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler, std::string_view may_be_none) {
  text = without_byte_order_mark(text);
  IntegerCsv csv(std::string(file_name), header, handler, may_be_none);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_suffix(line.ends_with('\r') ? 1 : 0);
    csv.take(line);
  }
}

}  // namespace dtof
