// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace dtof {

/// The sensor is sensitive in [begin_s, end_s) only; within [0, T_int].
struct TimeGate {
  double begin_s;
  double end_s;

  bool operator==(const TimeGate&) const = default;
};

/// What the photon source has to know of laser, sensor and TDC (spec section 4). The defaults are those of
/// the preset "thesis" (sensor/presets/thesis.toml).
struct SensorModel {
  std::string name;
  int columns = 200;                  ///< of the array, >= 1
  int rows = 160;                     ///< of the array, >= 1
  double field_of_view_deg = 96.0;    ///< over all columns, above 0 to 180; pixels see equal angles
  int np = 10;                        ///< NP, bits of a timestamp, 3 .. 16
  int slots = 2;                      ///< events the TDC keeps per acquisition, >= 1
  std::uint32_t acquisitions = 3333;  ///< laser pulses per frame
  double integration_time_s = 45e-9;  ///< T_int, > 0
  double pulse_fwhm_s = 2e-9;         ///< Gaussian pulse, > 0
  double signal_events_1m = 0.30;     ///< per pulse and pixel at 1 m and reflectivity 1; falls with R^-2
  double background_events_per_klux = 0.15 / 14.0;  ///< per T_int and pixel at reflectivity 1, without DCR
  double dark_count_rate_hz = 1e4;                  ///< DCR, independent of reflectivity
  double dead_time_s = 0.0;                         ///< non-paralysable, per pixel; 0 = none
  double default_reflectivity = 1.0;                ///< of scenes that do not say their own

  // Improvement methods of thesis section 2.2.4.
  int binning = 1;  ///< B: blocks of B x B pixels share one stream; 1 = off
  std::optional<TimeGate> time_gate;
  std::optional<double> coincidence_window_s;  ///< W; >= 0

  /// Angle that a pixel sees.
  [[nodiscard]] double degrees_per_pixel() const { return field_of_view_deg / columns; }
  /// T_res = T_int / 2^NP.
  [[nodiscard]] double time_resolution_s() const;
  /// Mean detectable signal events of a pixel per pulse.
  [[nodiscard]] double signal_events(double depth_m, double reflectivity) const;
  /// Mean background events of a pixel per T_int, dark counts included.
  [[nodiscard]] double background_events(double klux, double reflectivity) const;

  /// Throws InputError with one sentence if a value is NaN, infinite, negative or outside its range.
  void validate() const;
};

}  // namespace dtof
