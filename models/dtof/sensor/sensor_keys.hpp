// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/photon/physics.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// What a file describes, before the rates that follow from its optics are computed.
struct SensorDraft {
  SensorModel model;
  OpticalInputs optics;
  double response_bin_s = 0.0;
  double response_first_bin = 0.0;
};

/// When a file must have a key.
enum class SensorKeyNeed {
  kAlways,
  kWithoutOptics,
  kWithOptics,
  kWithoutResponse,
  kWithSection,  ///< whenever the file has the key's section
  kNever,        ///< the default stands
};

/// A number of the file. Units are those of the key's name; dividing by a power of ten, which a double holds
/// exactly, gives the double nearest to the decimal number in SI units.
struct SensorNumberKey {
  std::string_view section;
  std::string_view name;
  SensorKeyNeed need;
  double lowest;
  bool lowest_allowed;
  double highest;
  bool whole;
  void (*set)(SensorDraft& draft, double value);
  std::string_view default_text;
  std::string_view meaning;
  std::string_view reason;  ///< of the limits
};

/// A key whose value is no number.
struct SensorOtherKey {
  std::string_view section;
  std::string_view name;
  std::string_view type;
  std::string_view default_text;
  std::string_view meaning;
};

/// All keys of a sensor file whose values are numbers, and all others.
std::span<const SensorNumberKey> sensor_number_keys();
std::span<const SensorOtherKey> sensor_other_keys();
/// Sections of a sensor file, in the order of the documentation.
std::span<const std::string_view> sensor_sections();
/// Keys of a section.
std::vector<std::string_view> sensor_keys_of(std::string_view section);
/// "0 to 5", or "above 0 to 5".
std::string sensor_key_limits(const SensorNumberKey& key);
/// "columns is 0, but must be 1 to 4096 (<reason>)" for a value outside of the limits; empty for one inside.
/// `text`: the value as the message has it.
std::string sensor_number_error(const SensorNumberKey& key, double value, std::string_view text);

/// Transmittance of a clear glass pane.
inline constexpr double kClearGlass = 0.92;

}  // namespace dtof
