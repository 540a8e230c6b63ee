// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Reads a sensor file (TOML, docs/user/sensor_file.md). A missing key gets the default of
/// sensor_key_table(); a missing effect is off. The name defaults to the file's name. Files that it names are
/// searched in its folder. Throws InputError "<path>:<line>: <reason>" for text that is no TOML, an unknown
/// key (with the nearest known one), a value of a wrong type or outside its limits, and a missing required
/// key.
SensorModel read_sensor_file(const std::filesystem::path& path);

/// Parses the text of a sensor file. `path` is for error messages, and its folder is searched for the files
/// that the text names.
SensorModel parse_sensor(std::string_view toml, const std::filesystem::path& path);

/// Copy of `sensor`, changed by part of a sensor file; keys that `toml` does not name keep their values.
SensorModel change_sensor(const SensorModel& sensor, std::string_view toml,
                          const std::filesystem::path& path);

/// Markdown table of all keys with meaning, default and limits.
std::string sensor_key_table();

}  // namespace dtof
