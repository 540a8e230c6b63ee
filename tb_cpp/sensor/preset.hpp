// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "photon/sensor_model.hpp"

namespace dtof {

/// "thesis": calibrated to the thesis's accuracy figures (0.30 / R^2 signal events, 0.15 background events
/// at 14 klux). "phone": 940 nm and a 20 nm filter, everything derived from OpticalInputs, reflectivity 0.5.
std::vector<std::string_view> preset_names();
/// Throws InputError that names the known presets.
SensorModel parse_preset(std::string_view name);

}  // namespace dtof
