// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "playground/session.hpp"

namespace dtof {

/// A request of text: lines of a name of PlaygroundRequest, a blank and its value; what no line names has its
/// default; "readout" may come several times. Throws InputError for another name and a value that is no
/// number or outside its limits.
PlaygroundRequest parse_playground_request(std::string_view text);

}  // namespace dtof
