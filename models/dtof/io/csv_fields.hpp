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

/// The fields of a line; a comma separates two.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// Stands for a field of -1, which means "no value" where this is legal.
inline constexpr std::uint64_t kNoCsvValue = std::numeric_limits<std::uint64_t>::max();

/// Called for each line with its number (the header is line 1) and its unsigned decimal fields.
using CsvLineHandler = std::function<void(std::size_t line, std::span<const std::uint64_t> fields)>;

/// Parses a CSV of unsigned decimal integers. `header`, the first line, gives the number and the names of the
/// fields. Taken as the same are: commas and semicolons, one of the two in a whole file; blanks around a
/// field; quotation marks around it; a fraction of zeros (100.0); empty lines behind the last one; a byte
/// order mark in front. In the field `may_be_none` -1 stands for no value (kNoCsvValue). Throws InputError
/// "<file>:<line>: <reason>" at the first malformed line.
void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler, std::string_view may_be_none = "");

/// Throws InputError "<file>:<line>: <reason>".
[[noreturn]] void fail_at_line(std::string_view file_name, std::size_t line, std::string_view reason);

}  // namespace dtof
