// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// The page's choices, one per line, fields separated by tabs: "readout" name title summary; "scene" name
/// summary; "sensor" name columns rows reflectivity acquisitions range in m, NP, SLOTS, T_int in ns, FWHM of
/// the pulse as a distance in m; "figure" name.
std::string playground_catalogue();
/// Line of one sensor in the catalogue.
std::string playground_sensor_line(std::string_view name, const SensorModel& sensor);

}  // namespace dtof
