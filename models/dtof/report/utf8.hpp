// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace dtof {

/// `text` as UTF-8, which pictures need: each byte that is no part of valid UTF-8 becomes the letter that it
/// is in Latin-1. A file's name may hold any bytes.
std::string as_utf8(std::string_view text);

}  // namespace dtof
