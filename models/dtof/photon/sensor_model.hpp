// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dtof/core/pulse_response.hpp"
#include "dtof/photon/surroundings.hpp"
#include "dtof/photon/tdc_codes.hpp"

namespace dtof {

/// The sensor is sensitive in [begin_s, end_s) only; within [0, T_int].
struct TimeGate {
  double begin_s;
  double end_s;

  bool operator==(const TimeGate&) const = default;
};

struct PixelPosition {
  int column;
  int row;

  bool operator==(const PixelPosition&) const = default;
};

/// Pixels that are hot (a dark count rate of their own) or dead (no events): those listed, and a share of all
/// that depends on `seed` alone, so that they are the same in every frame.
struct PixelDefects {
  double hot_share = 0.0;               ///< 0 .. 1, together with dead_share at most 1
  double dead_share = 0.0;              ///< 0 .. 1
  std::vector<PixelPosition> hot;       ///< also hot, unless dead
  std::vector<PixelPosition> dead;      ///< also dead
  double hot_dark_count_rate_hz = 0.0;  ///< of a hot pixel, >= 0
  std::uint64_t seed = 1;

  [[nodiscard]] bool none() const {
    return hot_share == 0.0 && dead_share == 0.0 && hot.empty() && dead.empty();
  }
  [[nodiscard]] bool is_hot(int column, int row) const;
  [[nodiscard]] bool is_dead(int column, int row) const;
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
  double pulse_fwhm_s = 2e-9;         ///< of the pulse, > 0; its mean arrival is this much after 2R/c
  double signal_events_1m = 0.30;     ///< per pulse and pixel at 1 m and reflectivity 1; falls with R^-2
  double background_events_per_klux = 0.15 / 14.0;  ///< per T_int and pixel at reflectivity 1, without DCR
  double dark_count_rate_hz = 1e4;                  ///< DCR, independent of reflectivity
  double dead_time_s = 0.0;                         ///< non-paralysable, per pixel; 0 = none
  double default_reflectivity = 1.0;                ///< of scenes that do not say their own

  // Measured or quoted effects, each off unless set.
  std::shared_ptr<const PulseResponse> pulse_response;  ///< in s; none: a Gaussian of pulse_fwhm_s
  double jitter_fwhm_s = 0.0;  ///< of the detector, normal; widens the pulse, its mean arrival stays
  /// A counted event is followed by another one with this probability, 0 .. 0.9, after the dead time and an
  /// exponential time of this constant (> 0 if the probability is).
  double afterpulse_probability = 0.0;
  double afterpulse_time_constant_s = 0.0;
  PixelDefects defects;
  std::shared_ptr<const TdcCodes> tdc_codes;  ///< none: equal codes
  double pulse_period_s = 0.0;                ///< from pulse to pulse; 0: a thirtieth of a second a frame
  Surroundings surroundings;

  // Improvement methods of thesis section 2.2.4.
  int binning = 1;  ///< B: blocks of B x B pixels share one stream; 1 = off
  std::optional<TimeGate> time_gate;
  std::optional<double> coincidence_window_s;  ///< W; >= 0

  /// Angle that a pixel sees.
  [[nodiscard]] double degrees_per_pixel() const { return field_of_view_deg / columns; }
  /// T_res = T_int / 2^NP.
  [[nodiscard]] double time_resolution_s() const;
  /// Standard deviation of a signal event's time, jitter included.
  [[nodiscard]] double pulse_sigma_s() const;
  /// The measured pulse in units of T_res, jitter included; null for a Gaussian.
  [[nodiscard]] std::shared_ptr<const PulseResponse> pulse_response_bins() const;
  /// Mean detectable signal events of a pixel per pulse.
  [[nodiscard]] double signal_events(double depth_m, double reflectivity) const;
  /// Mean background events of a pixel per T_int, dark counts included.
  [[nodiscard]] double background_events(double klux, double reflectivity) const;

  /// From pulse to pulse, s.
  [[nodiscard]] double pulse_period() const;
  /// The sensor with nothing between it and its targets, a settled laser and no skew, as a host calibrates
  /// it.
  [[nodiscard]] SensorModel as_calibrated() const;

  /// Throws InputError with one sentence if a value is NaN, infinite, negative or outside its range.
  void validate() const;
};

}  // namespace dtof
