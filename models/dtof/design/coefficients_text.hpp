// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace dtof {

/// Text of coefficients.toml, compiled into the program.
std::string_view coefficients_text();

}  // namespace dtof
