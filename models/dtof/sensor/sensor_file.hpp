// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Reads a sensor file (TOML, docs/user/sensor_file.md). What the file does not name is off or has the
/// default of sensor_key_table(); the name defaults to the file's. Files that it names are looked for beside
/// it. Throws InputError "<path>:<line>: <reason>" for text that is no TOML, a key that is not known (with
/// the nearest known one), a value of a wrong type or outside its limits, and a key that is missing.
SensorModel read_sensor_file(const std::filesystem::path& path);

/// The same of a text; `path` is for messages and for the files that the text names.
SensorModel parse_sensor(std::string_view toml, const std::filesystem::path& path);

/// `sensor` with what a part of a sensor file says instead; keys that the text does not name stay.
SensorModel change_sensor(const SensorModel& sensor, std::string_view toml,
                          const std::filesystem::path& path);

/// Markdown table of all keys with meaning, default and limits.
std::string sensor_key_table();

}  // namespace dtof
