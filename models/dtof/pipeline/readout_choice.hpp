// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Names of the parameters that are free for the read-out and change its results: NP, SLOTS and its own
/// (readouts.toml).
std::vector<std::string_view> parameter_names(Readout readout);
/// Value of a parameter. Throws InputError if the read-out does not have it.
int get_parameter(const ReadoutParameters& parameters, std::string_view name);
/// Sets a parameter. Throws InputError if the read-out does not have it, and for a WINDOW_CENTRED other than
/// 0 and 1. Other ranges are checked by ReadoutParameters::validate.
void set_parameter(ReadoutParameters& parameters, std::string_view name, int value);

}  // namespace dtof
