// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "rtl/configuration.hpp"

namespace dtof {

/// Throws InputError that names `option` unless the current folder holds the project's synthesis flow.
void check_flow(const std::string& option);

/// Runs `synth/synth.py run` for an array and returns its figures as text for a report. Throws
/// InputError that names `option` if the flow fails.
std::string measured_by_flow(const std::string& option, const RtlConfiguration& configuration,
                             double clock_mhz);

}  // namespace dtof
