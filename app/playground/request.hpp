// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "playground/session.hpp"

namespace dtof {

/// Parses a request. Each line has a name of PlaygroundRequest, a blank and a value. Names that are missing
/// keep their defaults; "readout" may be repeated. Throws InputError for an unknown name, and for a value
/// that is no number or outside its limits.
PlaygroundRequest parse_playground_request(std::string_view text);

}  // namespace dtof
