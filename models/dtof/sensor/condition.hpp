// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// A named part of a sensor file that can be laid over any sensor (sensor/conditions.toml, compiled into the
/// program).
struct Condition {
  std::string name;
  std::string says;  ///< one sentence without its full stop
};

/// In the file's order.
const std::vector<Condition>& conditions();
/// The sensor under this condition, named "<sensor>-<condition>". Throws InputError that names the known
/// ones.
SensorModel under_condition(const SensorModel& sensor, std::string_view condition);

}  // namespace dtof
