// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/physics.hpp"

#include <cmath>
#include <numbers>

#include "dtof/core/physical_constants.hpp"

namespace dtof {

double pulse_energy_j(const OpticalInputs& inputs) {
  return inputs.peak_power_w * inputs.pulse_fwhm_s * std::sqrt(std::numbers::pi / (4.0 * std::numbers::ln2));
}

double photon_energy_j(const OpticalInputs& inputs) {
  return kPlanckConstant * kSpeedOfLight / inputs.wavelength_m;
}

double collected_share(const OpticalInputs& inputs, double distance_m) {
  return inputs.lens_area_m2 / std::numbers::pi / distance_m / distance_m * inputs.lens_efficiency * 2.0 /
         std::numbers::pi;
}

double signal_events_per_pulse(const OpticalInputs& inputs, double distance_m, double reflectivity) {
  const double pixel_energy_j =
      pulse_energy_j(inputs) * reflectivity * collected_share(inputs, distance_m) / inputs.spad_count;
  return pixel_energy_j / photon_energy_j(inputs) * inputs.pde;
}

double sunlight_events_per_window(const OpticalInputs& inputs, double klux, double reflectivity) {
  // The seen area grows with R^2 as the collected share falls: any distance gives the same.
  constexpr double kDistance = 1.0;
  const double half_angle = inputs.afov_deg / 2.0 * std::numbers::pi / 180.0;
  const double seen_side_m = 2.0 * kDistance * std::tan(half_angle);
  const double irradiance_w_m2 = inputs.solar_irradiance * 1e-3 * inputs.filter_width_nm * klux;
  const double pixel_power_w =
      irradiance_w_m2 * seen_side_m * seen_side_m * reflectivity * collected_share(inputs, kDistance);
  return inputs.integration_time_s * pixel_power_w / photon_energy_j(inputs) * inputs.pde;
}

double dark_events_per_window(const OpticalInputs& inputs) {
  return inputs.dark_count_rate_hz * inputs.integration_time_s;
}

double background_events_per_window(const OpticalInputs& inputs, double klux, double reflectivity) {
  return sunlight_events_per_window(inputs, klux, reflectivity) + dark_events_per_window(inputs);
}

double arrival_centre_s(double distance_m, double pulse_fwhm_s) {
  return 2.0 * distance_m / kSpeedOfLight + pulse_fwhm_s;
}

double pulse_sigma_s(double pulse_fwhm_s) {
  return pulse_fwhm_s / (2.0 * std::sqrt(2.0 * std::numbers::ln2));
}

}  // namespace dtof
