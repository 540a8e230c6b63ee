// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace dtof {

/// The fields of a line; a comma separates two.
std::vector<std::string_view> split_at_commas(std::string_view text);

/// Called for each line with its number (the header is line 1) and its unsigned decimal fields.
using CsvLineHandler = std::function<void(std::size_t line, std::span<const std::uint64_t> fields)>;

/// Parses a CSV of unsigned decimal integers. `header` is the exact first line and gives the number and the
/// names of the fields. Throws InputError "<file>:<line>: <reason>" at the first malformed line.
void parse_integer_csv(std::string_view file_name, std::string_view text, std::string_view header,
                       const CsvLineHandler& handler);

/// Throws InputError "<file>:<line>: <reason>".
[[noreturn]] void fail_at_line(std::string_view file_name, std::size_t line, std::string_view reason);

}  // namespace dtof
