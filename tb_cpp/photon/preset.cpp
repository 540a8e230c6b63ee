// SPDX-License-Identifier: Apache-2.0
#include "photon/preset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

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

void require_at_least_zero(double value, std::string_view what) {
  if (!std::isfinite(value) || value < 0.0) {
    throw InputError(
        fmt::format("sensor model: {} must be a finite number of at least 0, not {}", what, value));
  }
}

void require_positive(double value, std::string_view what) {
  if (!std::isfinite(value) || value <= 0.0) {
    throw InputError(fmt::format("sensor model: {} must be a finite number above 0, not {}", what, value));
  }
}

}  // namespace

double SensorModel::time_resolution_s() const { return std::ldexp(integration_time_s, -np); }

double SensorModel::signal_events(double depth_m, double reflectivity) const {
  return signal_events_1m * reflectivity / depth_m / depth_m;
}

double SensorModel::background_events(double klux, double reflectivity) const {
  return background_events_per_klux * klux * reflectivity + dark_count_rate_hz * integration_time_s;
}

void SensorModel::validate() const {
  if (np < 3 || np > 16) {
    throw InputError(fmt::format("sensor model: NP must be 3 to 16, not {}", np));
  }
  if (slots < 1) {
    throw InputError(fmt::format("sensor model: SLOTS must be at least 1, not {}", slots));
  }
  if (binning < 1) {
    throw InputError(fmt::format("sensor model: binning must be at least 1, not {}", binning));
  }
  require_positive(integration_time_s, "integration time (s)");
  require_positive(pulse_fwhm_s, "pulse FWHM (s)");
  require_at_least_zero(signal_events_1m, "signal events at 1 m");
  require_at_least_zero(background_events_per_klux, "background events per klux");
  require_at_least_zero(dark_count_rate_hz, "dark count rate (Hz)");
  require_at_least_zero(dead_time_s, "dead time (s)");
  require_at_least_zero(default_reflectivity, "reflectivity");
  if (coincidence_window_s) {
    require_at_least_zero(*coincidence_window_s, "coincidence window (s)");
  }
  // Written so that a NaN fails.
  if (time_gate && !(time_gate->begin_s >= 0.0 && time_gate->begin_s < time_gate->end_s &&
                     time_gate->end_s <= integration_time_s)) {
    throw InputError(fmt::format(
        "sensor model: the time gate [{} s, {} s) must be inside [0, {} s], its begin below its end",
        time_gate->begin_s, time_gate->end_s, integration_time_s));
  }
}

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
