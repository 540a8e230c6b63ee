// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

namespace dtof {

/// A file of sensor/presets/, compiled into the program so that it runs from any folder.
struct PresetText {
  std::string_view name;  ///< file name without .toml
  std::string_view toml;
};
const std::vector<PresetText>& preset_texts();
/// Text of sensor/conditions.toml.
std::string_view conditions_text();

}  // namespace dtof
