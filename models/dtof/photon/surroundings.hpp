// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace dtof {

// What lies between a sensor and its targets, and what a laser, a TDC and a target do during a frame. Each is
// off unless it is set. Distances are in m, times in s; events are those of a pixel and pulse.

/// Crosstalk of the cover glass: light that the glass before laser and lens scatters straight into the
/// pixels, an early return that is the same in every pulse and pixel.
struct CoverGlass {
  double events = 0.0;  ///< 0: no glass
  double distance_m = 0.03;

  bool operator==(const CoverGlass&) const = default;
};

/// A homogeneous medium that scatters: fog, smoke, dust. With the extinction alpha and the lidar ratio L, a
/// layer dR at R returns S pi (alpha / L) exp(-2 alpha R) / R^2 dR events, S being the sensor's events of a
/// Lambertian target of reflectivity 1 at 1 m, whose backscatter is 1 / pi per sr; a target at R keeps
/// exp(-2 alpha R) of its signal. Single scattering. Sunlight stays as it is: what the fog takes from the
/// target's it adds of its own.
struct Fog {
  double extinction_per_m = 0.0;  ///< alpha; 0: no fog
  double lidar_ratio_sr = 18.8;   ///< L, extinction over backscatter; water droplets (O'Connor et al. 2004)
  double overlap_m = 0.1;  ///< from here on a pixel sees what the laser lights; nothing returns from before

  bool operator==(const Fog&) const = default;
};

/// A pane of glass before what is behind it: a first surface of its own, Lambertian, e.g. by its dust. It
/// attenuates what is behind twice, and the sunlight of what is behind once.
struct Pane {
  double distance_m = 0.0;  ///< 0: no pane
  double reflectivity = 0.0;
  double transmittance = 1.0;

  bool operator==(const Pane&) const = default;
};

/// The laser of another sensor, which every pixel sees alike. It fires (1 + rate_offset) times as often as
/// the sensor's own, and its first pulse arrives `first_arrival_s` after the frame's begin.
struct OtherLaser {
  double events = 0.0;       ///< of each of its pulses; 0: no other laser
  double rate_offset = 0.0;  ///< relative, above -1; 6e-6: 6 ppm faster
  double first_arrival_s = 0.0;
  double pulse_fwhm_s = 0.0;  ///< Gaussian; 0: that of the sensor's own pulse

  bool operator==(const OtherLaser&) const = default;
};

/// Targets that come nearer or go away during the frame. A target's distance is that at the frame's middle.
struct RadialMotion {
  double velocity_m_per_s = 0.0;  ///< along the pixel's ray, above 0: away

  bool operator==(const RadialMotion&) const = default;
};

/// A laser that is not settled when the frame begins. Power and delay approach their final values
/// exponentially from the first pulse on.
struct LaserSettling {
  double silent_share = 0.0;  ///< of the frame, 0 to 1, at its begin: no pulses
  double power_drop = 0.0;    ///< 0 to 1; the first pulse has 1 - power_drop of the final power
  double delay_s = 0.0;       ///< of the first pulse
  double time_share = 0.0;    ///< time constant over the frame's length; above 0 with the two before
  double power_drift = 0.0;   ///< linear, from 1 - drift / 2 to 1 + drift / 2 over the frame; -2 to 2

  bool operator==(const LaserSettling&) const = default;

  /// Power of the pulse of this acquisition over the final power, drift included.
  [[nodiscard]] double power(std::uint32_t acquisition, std::uint32_t acquisitions) const;
  [[nodiscard]] double delay(std::uint32_t acquisition, std::uint32_t acquisitions) const;
};

enum class SkewPattern {
  kAlternating,  ///< even columns by plus, odd ones by minus the skew
  kRamp,         ///< from minus at the first column to plus at the last
  kRandom,       ///< uniform between minus and plus, of each column by itself
};

/// Delay of a pixel's timestamps by the way of the TDC's clock or start signal. Nothing of the sunlight's
/// flat distribution changes.
struct TimingSkew {
  double column_s = 0.0;  ///< of columns, by the pattern
  SkewPattern pattern = SkewPattern::kRandom;
  double pixel_s = 0.0;  ///< uniform between minus and plus, of each pixel by itself; adds to its column's
  std::uint64_t seed = 1;

  bool operator==(const TimingSkew&) const = default;

  [[nodiscard]] bool none() const { return column_s == 0.0 && pixel_s == 0.0; }
  /// Skew of a pixel of an array of `columns`, the same in every frame.
  [[nodiscard]] double of_pixel(int column, int row, int columns) const;
};

/// Firing offsets (start dither): shot and start of the TDC are delayed together by a pseudo-random number of
/// steps, 0 to 2^bits - 1, so that only what does not follow the laser moves. Low bits of a linear feedback
/// register of 16 bits (x^16 + x^14 + x^13 + x^11 + 1) that makes 16 steps for each pulse and starts anew in
/// every frame.
struct FiringOffsets {
  int bits = 0;  ///< 0: off; at most 12
  double step_s = 0.0;
  std::uint16_t seed = 1;  ///< not 0

  bool operator==(const FiringOffsets&) const = default;

  /// Delay of each pulse, in s; empty if off.
  [[nodiscard]] std::vector<double> delays(std::uint32_t acquisitions) const;
};

struct Surroundings {
  CoverGlass cover_glass;
  Fog fog;
  Pane pane;
  OtherLaser other_laser;
  RadialMotion motion;
  LaserSettling settling;
  TimingSkew skew;
  FiringOffsets firing_offsets;

  bool operator==(const Surroundings&) const = default;

  /// Nothing changes a photon. Firing offsets alone do not.
  [[nodiscard]] bool none() const;
  /// The signal's rate or time changes during the frame.
  [[nodiscard]] bool signal_changes() const;

  /// Share of the light of a target at this distance that comes back.
  [[nodiscard]] double two_way_transmittance(double distance_m) const;
  /// Share of a target's sunlight that reaches the sensor.
  [[nodiscard]] double sunlight_share(double distance_m, bool target) const;

  /// Throws InputError with one sentence for a value that is NaN, infinite or outside its range.
  void validate() const;
};

/// Mean backscattered events of a pulse from the fog up to `distance_m`, without a pane: S pi alpha / L
/// (E2(2 alpha R0) / R0 - E2(2 alpha R) / R), with E2 the exponential integral and R0 the overlap.
double fog_events(const Fog& fog, double signal_events_1m, double distance_m);

}  // namespace dtof
