// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace dtof {

inline constexpr double kPlanckConstant = 6.62607015e-34;  ///< J s

/// Inputs of the optical link budget (thesis section 3.2), for pixels of one SPAD. The defaults are the
/// thesis's system.
struct OpticalInputs {
  double peak_power_w = 20.0;  ///< peak laser power of the pulse, for all pixels together
  double pulse_fwhm_s = 2e-9;  ///< Gaussian pulse
  double wavelength_m = 905e-9;
  double lens_area_m2 = 1.16e-6;  ///< pi D^2 / 4
  double lens_efficiency = 0.7;   ///< eta_lens, 0 .. 1
  double pde = 0.2;               ///< photon detection efficiency, 0 .. 1
  double spad_count = 32000.0;    ///< M, SPADs that share the light of the lens
  double afov_deg = 0.48;         ///< field of view of one pixel
  double filter_width_nm = 1.0;
  double solar_irradiance = 6.3;  ///< mW/m2/nm per klux on the target (ASTM G173 averaged over 20 nm)
  double dark_count_rate_hz = 1e4;
  double integration_time_s = 45e-9;  ///< T_int
};

/// Energy of one Gaussian pulse, J: peak power x FWHM x sqrt(pi / (4 ln 2)).
double pulse_energy_j(const OpticalInputs& inputs);
/// Energy of one photon, J: h c / wavelength (Eq. 3.5).
double photon_energy_j(const OpticalInputs& inputs);
/// Share of the light from a Lambertian target of reflectivity 1 at `distance_m` that all SPADs together
/// receive: (D / 2R)^2 eta 2 / pi (Eq. 3.1 to 3.3 without 1/M).
double collected_share(const OpticalInputs& inputs, double distance_m);

/// Detected signal events of one pixel per pulse (Eq. 3.1 to 3.6). `distance_m` > 0, `reflectivity` >= 0.
double signal_events_per_pulse(const OpticalInputs& inputs, double distance_m, double reflectivity);
/// Detected events of one pixel per T_int from sunlight that the target reflects. Eq. 3.7 to 3.9; Eq. 3.8
/// without its 1/M, since AFOV is per pixel. Independent of distance, flat in time.
double sunlight_events_per_window(const OpticalInputs& inputs, double klux, double reflectivity);
/// Dark counts of one pixel per T_int (second term of Eq. 3.10).
double dark_events_per_window(const OpticalInputs& inputs);
/// Sunlight plus dark counts of one pixel per T_int (Eq. 3.10).
double background_events_per_window(const OpticalInputs& inputs, double klux, double reflectivity);

/// Mean arrival time of a target's light, s: 2R/c + FWHM (spec section 4).
double arrival_centre_s(double distance_m, double pulse_fwhm_s);
/// Standard deviation of a Gaussian pulse, s: FWHM / (2 sqrt(2 ln 2)) = FWHM / 2.3548.
double pulse_sigma_s(double pulse_fwhm_s);

}  // namespace dtof
