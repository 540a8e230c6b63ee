// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "dtof/core/parameters.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Throws InputError, which names the option, unless the project's synthesis flow is in this folder.
void check_flow(const std::string& option);

/// What `synth/synth.py run` says of a read-out's array for a sensor, as text of a report. Throws InputError
/// that names the option if the flow fails.
std::string measured_by_flow(const std::string& option, const ReadoutParameters& parameters,
                             const SensorModel& sensor, double clock_mhz);

}  // namespace dtof
