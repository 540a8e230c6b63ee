// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Names of the sensor files that are compiled into the program (sensor/presets/), e.g. "thesis".
std::vector<std::string_view> preset_names();
/// Sensor of a preset. Throws InputError that lists the known presets.
SensorModel parse_preset(std::string_view name);

/// Sensor for the option --sensor: a preset's name, or else the path of a sensor file. Conditions
/// (sensor/condition.hpp) may follow, each after a "+": thesis+fog+motion. Throws InputError for an unknown
/// name or an illegal file.
SensorModel find_sensor(std::string_view name_or_file);

/// A sensor and the text of its file, which is read once.
struct DescribedSensor {
  std::string text;
  SensorModel model;
};

/// As find_sensor, with the text of the sensor's file.
DescribedSensor find_described_sensor(std::string_view name_or_file);
/// Text of a preset's file. Throws InputError that lists the known presets.
std::string_view preset_text(std::string_view name);

}  // namespace dtof
