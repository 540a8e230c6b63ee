// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace dtof {

/// Column list of the command line: "all" (empty list), or numbers and ranges such as "0-9,20,30-32".
/// Throws InputError for anything else, a column named twice, or one that is not below `columns`.
std::vector<int> parse_columns(std::string_view text, int columns);

}  // namespace dtof
