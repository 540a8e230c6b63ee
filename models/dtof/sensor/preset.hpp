// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Names of the sensor files that are compiled into the program (sensor/presets/): thesis, thesis_1mhz,
/// thesis_full, phone.
std::vector<std::string_view> preset_names();
/// Throws InputError that names the known presets.
SensorModel parse_preset(std::string_view name);

/// What --sensor takes: a preset's name, or else the path of a sensor file; behind it any conditions
/// (sensor/condition.hpp), each after a "+": thesis+fog+motion. Throws InputError.
SensorModel find_sensor(std::string_view name_or_file);

/// A sensor and the file that describes it, which has been read once.
struct DescribedSensor {
  std::string text;
  SensorModel model;
};

/// The same with its text.
DescribedSensor find_described_sensor(std::string_view name_or_file);
/// The text of that file, after it has been checked. Throws InputError.
std::string_view preset_text(std::string_view name);

}  // namespace dtof
