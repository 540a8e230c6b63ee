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

/// Time gate: the sensor detects only in [begin_s, end_s), which lies within [0, T_int].
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

/// Hot pixels (with a dark count rate of their own) and dead pixels (without events). Both are listed, or
/// drawn as a share of all pixels. The draw depends on `seed` alone, so the pixels are the same in every
/// frame.
struct PixelDefects {
  double hot_share = 0.0;               ///< 0 .. 1, together with dead_share at most 1
  double dead_share = 0.0;              ///< 0 .. 1
  std::vector<PixelPosition> hot;       ///< hot in addition to hot_share, unless dead
  std::vector<PixelPosition> dead;      ///< dead in addition to dead_share
  double hot_dark_count_rate_hz = 0.0;  ///< dark count rate of a hot pixel, >= 0
  std::uint64_t seed = 1;

  [[nodiscard]] bool none() const {
    return hot_share == 0.0 && dead_share == 0.0 && hot.empty() && dead.empty();
  }
  [[nodiscard]] bool is_hot(int column, int row) const;
  [[nodiscard]] bool is_dead(int column, int row) const;
};

/// Laser, sensor and TDC as the photon source models them (spec section 4). The defaults are the preset
/// "thesis" (sensor/presets/thesis.toml).
struct SensorModel {
  std::string name;
  int columns = 200;                  ///< columns of the array, >= 1
  int rows = 160;                     ///< rows of the array, >= 1
  double field_of_view_deg = 96.0;    ///< angle over all columns, above 0 to 180; all pixels see equal angles
  int np = 10;                        ///< NP, bits of a timestamp, 3 .. 16
  int slots = 2;                      ///< events the TDC keeps per acquisition, >= 1
  std::uint32_t acquisitions = 3333;  ///< laser pulses per frame
  double integration_time_s = 45e-9;  ///< T_int, > 0
  double pulse_fwhm_s = 2e-9;         ///< FWHM of the pulse, > 0; the mean arrival time is 2R/c plus this
  double signal_events_1m = 0.30;     ///< per pulse and pixel at 1 m and reflectivity 1; falls with R^-2
  double background_events_per_klux = 0.15 / 14.0;  ///< per T_int and pixel at reflectivity 1, without DCR
  double dark_count_rate_hz = 1e4;                  ///< DCR, independent of reflectivity
  double dead_time_s = 0.0;                         ///< non-paralysable, per pixel; 0 = none
  double default_reflectivity = 1.0;                ///< for scenes that do not specify one

  // Measured or quoted effects. Each is off by default.
  std::shared_ptr<const PulseResponse> pulse_response;  ///< in s; null: a Gaussian of pulse_fwhm_s
  /// Jitter of the detector, normal; widens the pulse around the same mean arrival time.
  double jitter_fwhm_s = 0.0;
  /// Probability, 0 .. 0.9, that another event follows a counted one, after the dead time plus an exponential
  /// time of the constant below (> 0 if the probability is).
  double afterpulse_probability = 0.0;
  double afterpulse_time_constant_s = 0.0;
  PixelDefects defects;
  std::shared_ptr<const TdcCodes> tdc_codes;  ///< null: equal code widths
  double pulse_period_s = 0.0;  ///< from pulse to pulse; 0: 1/30 s divided by the pulses of a frame
  Surroundings surroundings;

  // Improvement methods of thesis section 2.2.4.
  int binning = 1;  ///< B: blocks of B x B pixels share one stream; 1 = off
  std::optional<TimeGate> time_gate;
  std::optional<double> coincidence_window_s;  ///< W; >= 0

  /// Angle that a pixel sees, degrees.
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

  /// Time from pulse to pulse, s.
  [[nodiscard]] double pulse_period() const;
  /// Copy without surroundings, laser settling and skew: the sensor as a host calibrates it.
  [[nodiscard]] SensorModel as_calibrated() const;

  /// Throws InputError with one sentence if a value is NaN, infinite, negative or outside its range.
  void validate() const;
};

}  // namespace dtof
