// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace dtof {

/// Converts `text`, which may hold any bytes (e.g. a file name), to UTF-8. Each byte that is no part of valid
/// UTF-8 is taken as Latin-1.
std::string as_utf8(std::string_view text);

}  // namespace dtof
