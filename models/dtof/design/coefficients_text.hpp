// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace dtof {

/// The file coefficients.toml.
std::string_view coefficients_text();

}  // namespace dtof
