// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

namespace dtof {

/// Splits a line at its commas.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// Value of a field that holds -1, where -1 is legal and means "no value".
inline constexpr std::uint64_t kNoCsvValue = std::numeric_limits<std::uint64_t>::max();

/// Called for each data line with its number (the header is line 1) and its fields.
using CsvLineHandler = std::function<void(std::size_t line, std::span<const std::uint64_t> fields)>;

/// Parses a CSV of unsigned decimal integers. `header`, the first line, gives the number and the names of the
/// fields. Field `may_be_none` may hold -1 (kNoCsvValue).
///
/// Accepted variants: semicolons instead of commas in the whole file; blanks or quotation marks around a
/// field; a fraction of zeros (100.0); empty lines at the end; a leading byte order mark.
///
/// Throws InputError "<file>:<line>: <reason>" at the first malformed line.
void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler, std::string_view may_be_none = "");

/// Throws InputError "<file>:<line>: <reason>".
[[noreturn]] void fail_at_line(std::string_view file_name, std::size_t line, std::string_view reason);

}  // namespace dtof
