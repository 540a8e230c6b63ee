// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// What the page offers, a line each, fields separated by tabulators:
/// "readout" name title summary; "scene" name summary; "sensor" name columns rows reflectivity acquisitions
/// range in m; "figure" name.
std::string playground_catalogue();
/// The line of one sensor.
std::string playground_sensor_line(std::string_view name, const SensorModel& sensor);

}  // namespace dtof
