// SPDX-License-Identifier: Apache-2.0
#include "sensor/preset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "core/error.hpp"
#include "photon/physics.hpp"

namespace dtof {
namespace {

SensorModel thesis_preset() {
  SensorModel model;
  model.name = "thesis";
  return model;
}

SensorModel phone_preset() {
  OpticalInputs inputs;
  inputs.wavelength_m = 940e-9;
  inputs.filter_width_nm = 20.0;
  inputs.solar_irradiance = 2.8;

  SensorModel model;
  model.name = "phone";
  model.integration_time_s = inputs.integration_time_s;
  model.pulse_fwhm_s = inputs.pulse_fwhm_s;
  model.signal_events_1m = signal_events_per_pulse(inputs, 1.0, 1.0);
  model.background_events_per_klux = sunlight_events_per_window(inputs, 1.0, 1.0);
  model.dark_count_rate_hz = inputs.dark_count_rate_hz;
  model.default_reflectivity = 0.5;
  return model;
}

struct Preset {
  std::string_view name;
  SensorModel (*make)();
};
constexpr std::array<Preset, 2> kPresets = {{{"thesis", thesis_preset}, {"phone", phone_preset}}};

}  // namespace

std::vector<std::string_view> preset_names() {
  std::vector<std::string_view> names;
  names.reserve(kPresets.size());
  for (const Preset& preset : kPresets) {
    names.push_back(preset.name);
  }
  return names;
}

SensorModel parse_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name == name) {
      return preset.make();
    }
  }
  throw InputError(fmt::format("unknown preset '{}': known are {}", name, fmt::join(preset_names(), ", ")));
}

}  // namespace dtof
