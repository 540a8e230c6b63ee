// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// A named part of a sensor file that can be added to any sensor (sensor/conditions.toml, compiled into the
/// program).
struct Condition {
  std::string name;
  std::string says;  ///< one sentence without its full stop, for help texts
};

/// All conditions, in the order of the file.
const std::vector<Condition>& conditions();
/// The sensor with this condition added, named "<sensor>-<condition>". Throws InputError that lists the known
/// conditions.
SensorModel under_condition(const SensorModel& sensor, std::string_view condition);

}  // namespace dtof
