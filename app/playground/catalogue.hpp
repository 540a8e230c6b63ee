// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace dtof {

/// What the page offers, a line each, fields separated by tabulators:
/// "readout" name title summary; "scene" name summary; "sensor" name columns rows reflectivity acquisitions
/// range in m; "figure" name.
std::string playground_catalogue();

}  // namespace dtof
