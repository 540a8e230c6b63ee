// SPDX-License-Identifier: Apache-2.0
#include "dtof/sensor/preset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/suggestion.hpp"
#include "dtof/io/input_file.hpp"
#include "dtof/sensor/condition.hpp"
#include "dtof/sensor/preset_texts.hpp"
#include "dtof/sensor/sensor_file.hpp"

namespace dtof {
namespace {

bool is_preset(std::string_view name) {
  return std::ranges::count(preset_texts(), name, &PresetText::name) > 0;
}

/// True if the sensor's name, which may be a file's, ends with this condition, or with it and others.
bool has_condition(std::string_view sensor, std::string_view condition) {
  for (std::size_t plus = sensor.rfind('+');
       plus != std::string_view::npos && !std::filesystem::exists(std::filesystem::path(sensor));
       plus = sensor.rfind('+')) {
    if (sensor.substr(plus + 1) == condition) {
      return true;
    }
    sensor = sensor.substr(0, plus);
  }
  return false;
}

}  // namespace

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  for (const PresetText& preset : preset_texts()) {
    names.push_back(preset.name);
  }
  return names;
}

std::string_view preset_text(std::string_view name) {
  const auto found = std::ranges::find(preset_texts(), name, &PresetText::name);
  if (found == preset_texts().end()) {
    throw InputError(unknown_name("preset", name, preset_names()));
  }
  return found->toml;
}

SensorModel parse_preset(std::string_view name) {
  return parse_sensor(preset_text(name), fmt::format("preset {}.toml", name));
}

SensorModel find_sensor(std::string_view name_or_file) { return find_described_sensor(name_or_file).model; }

DescribedSensor find_described_sensor(std::string_view name_or_file) {
  if (is_preset(name_or_file)) {
    return {std::string(preset_text(name_or_file)), parse_preset(name_or_file)};
  }
  const std::filesystem::path path(name_or_file);
  if (const auto plus = name_or_file.rfind('+');
      plus != std::string_view::npos && !std::filesystem::exists(path)) {
    const std::string_view condition = name_or_file.substr(plus + 1);
    if (has_condition(name_or_file.substr(0, plus), condition)) {
      throw InputError(fmt::format("{}: condition '{}' is named twice", name_or_file, condition));
    }
    return {fmt::format("# {}: no file, but a sensor under conditions\n", name_or_file),
            under_condition(find_sensor(name_or_file.substr(0, plus)), condition)};
  }
  if (!path.has_extension() && !std::filesystem::exists(path)) {
    throw InputError(
        fmt::format("{}, and there is no such file", unknown_name("preset", name_or_file, preset_names())));
  }
  std::string text = read_file(path);
  SensorModel model = parse_sensor(text, path);
  return {std::move(text), std::move(model)};
}

}  // namespace dtof
