// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// The parameters of readouts.toml that can be chosen for the read-out and change its results: NP, SLOTS and
/// its choices.
std::vector<std::string_view> parameter_names(Readout readout);
/// Throws InputError for a parameter that the read-out does not have.
int get_parameter(const ReadoutParameters& parameters, std::string_view name);
/// Sets one of the parameters that the read-out has. Throws InputError for another name, and for a
/// WINDOW_CENTRED that is neither 0 nor 1; ReadoutParameters::validate knows the other ranges.
void set_parameter(ReadoutParameters& parameters, std::string_view name, int value);

}  // namespace dtof
