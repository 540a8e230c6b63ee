// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace dtof {

// Effects between a sensor and its targets, and changes of laser, TDC and target during a frame. Each effect
// is off by default. Distances are in m, times in s, events per pixel and pulse.

/// Crosstalk of the cover glass: light that the glass in front of laser and lens scatters straight into the
/// pixels. This early return is the same in every pulse and pixel.
struct CoverGlass {
  double events = 0.0;  ///< 0: no glass
  double distance_m = 0.03;

  bool operator==(const CoverGlass&) const = default;
};

/// A homogeneous scattering medium: fog, smoke, dust. Single scattering.
///
/// With the extinction alpha and the lidar ratio L, a layer dR at R returns S pi (alpha / L) exp(-2 alpha R)
/// / R^2 dR events. S is the sensor's signal from a Lambertian target of reflectivity 1 at 1 m, whose
/// backscatter is 1 / pi per sr. A target at R keeps exp(-2 alpha R) of its signal. Sunlight is unchanged:
/// the fog's own scattered sunlight replaces what it takes from the target's.
struct Fog {
  double extinction_per_m = 0.0;  ///< alpha; 0: no fog
  /// L, extinction divided by backscatter; water droplets (O'Connor et al. 2004).
  double lidar_ratio_sr = 18.8;
  double overlap_m = 0.1;  ///< nearest distance that both laser and pixel cover; no return from nearer

  bool operator==(const Fog&) const = default;
};

/// A pane of glass in front of the target. Its surface, e.g. with dust, is a Lambertian target of its own.
/// The pane attenuates the laser light of targets behind it twice, and their sunlight once.
struct Pane {
  double distance_m = 0.0;  ///< 0: no pane
  double reflectivity = 0.0;
  double transmittance = 1.0;

  bool operator==(const Pane&) const = default;
};

/// The laser of another sensor, seen equally by every pixel. It fires (1 + rate_offset) times as often as the
/// sensor's own laser. Its first pulse arrives `first_arrival_s` after the frame's start.
struct OtherLaser {
  double events = 0.0;       ///< events of each of its pulses; 0: no other laser
  double rate_offset = 0.0;  ///< relative, above -1; 6e-6: 6 ppm faster
  double first_arrival_s = 0.0;
  double pulse_fwhm_s = 0.0;  ///< Gaussian; 0: FWHM of the sensor's own pulse

  bool operator==(const OtherLaser&) const = default;
};

/// Targets that approach or recede during the frame. A target's distance is its distance at the frame's
/// middle.
struct RadialMotion {
  double velocity_m_per_s = 0.0;  ///< along the pixel's ray; above 0: away

  bool operator==(const RadialMotion&) const = default;
};

/// A camera that moves sideways during the frame: pulse by pulse each pixel looks at another place of
/// the scene. At the frame's middle it looks at its own pixel of the scene. Between two pixels of the scene
/// it sees both, by the areas that its square shares with them. Beyond its edge the scene goes on with its
/// outermost pixels.
struct LateralMotion {
  double columns_per_frame = 0.0;  ///< above 0: to the right, so that the scene moves to the left
  double rows_per_frame = 0.0;     ///< above 0: down

  bool operator==(const LateralMotion&) const = default;

  [[nodiscard]] bool none() const { return columns_per_frame == 0.0 && rows_per_frame == 0.0; }
};

/// A pixel of the scene that a moving pixel sees in the pulses from `first` to below `end`.
struct SeenPixel {
  int columns = 0;  ///< to the right of the pixel's own
  int rows = 0;     ///< below the pixel's own
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  double largest_share = 0.0;  ///< of the pixel's area, over these pulses

  bool operator==(const SeenPixel&) const = default;
};

/// Share of a moving pixel's area that shows a pixel of the scene in this acquisition.
double seen_share(const LateralMotion& motion, const SeenPixel& seen, std::uint32_t acquisition,
                  std::uint32_t acquisitions);
/// All pixels of the scene that a moving pixel sees during a frame; empty without motion.
std::vector<SeenPixel> seen_pixels(const LateralMotion& motion, std::uint32_t acquisitions);

/// A laser that is not settled when the frame starts. Power and delay approach their final values
/// exponentially, from the first pulse.
struct LaserSettling {
  double silent_share = 0.0;  ///< share of the frame, 0 to 1, at its start: no pulses
  double power_drop = 0.0;    ///< 0 to 1; the first pulse has 1 - power_drop of the final power
  double delay_s = 0.0;       ///< additional delay of the first pulse
  /// Time constant divided by the frame's length; above 0 if power_drop or delay_s is set.
  double time_share = 0.0;
  double power_drift = 0.0;  ///< linear, from 1 - drift / 2 to 1 + drift / 2 over the frame; -2 to 2

  bool operator==(const LaserSettling&) const = default;

  /// Power of the pulse of this acquisition relative to the final power, drift included.
  [[nodiscard]] double power(std::uint32_t acquisition, std::uint32_t acquisitions) const;
  [[nodiscard]] double delay(std::uint32_t acquisition, std::uint32_t acquisitions) const;
};

enum class SkewPattern {
  kAlternating,  ///< even columns by +skew, odd columns by -skew
  kRamp,         ///< linear from -skew at the first column to +skew at the last
  kRandom,       ///< uniform between -skew and +skew, independent for each column
};

/// Delay of a pixel's timestamps caused by the distribution of the TDC's clock or start signal. The flat
/// distribution of sunlight does not change.
struct TimingSkew {
  double column_s = 0.0;  ///< skew of a column, distributed by the pattern
  SkewPattern pattern = SkewPattern::kRandom;
  /// Uniform between -pixel_s and +pixel_s, independent for each pixel; added to the column's skew.
  double pixel_s = 0.0;
  std::uint64_t seed = 1;

  bool operator==(const TimingSkew&) const = default;

  [[nodiscard]] bool none() const { return column_s == 0.0 && pixel_s == 0.0; }
  /// Skew of a pixel, s, in an array of `columns`; the same in every frame.
  [[nodiscard]] double of_pixel(int column, int row, int columns) const;
};

/// Firing offsets (start dither). Laser shot and TDC start are delayed together by a pseudo-random number of
/// steps, 0 to 2^bits - 1, so only events that do not follow the laser move. The number is the low bits of a
/// 16-bit linear feedback shift register (x^16 + x^14 + x^13 + x^11 + 1). The register makes 16 steps per
/// pulse and restarts in every frame.
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
  LateralMotion lateral;
  LaserSettling settling;
  TimingSkew skew;
  FiringOffsets firing_offsets;

  bool operator==(const Surroundings&) const = default;

  /// True if no effect changes a photon's time or number. Firing offsets alone count as none.
  [[nodiscard]] bool none() const;
  /// True if the signal's rate or time changes during the frame.
  [[nodiscard]] bool signal_changes() const;

  /// Share of the laser light of a target at this distance that returns, after fog and pane.
  [[nodiscard]] double two_way_transmittance(double distance_m) const;
  /// Share of a target's sunlight that reaches the sensor, 0 .. 1.
  [[nodiscard]] double sunlight_share(double distance_m, bool target) const;

  /// Throws InputError with one sentence for a value that is NaN, infinite or outside its range.
  void validate() const;
};

/// Mean backscattered events of a pulse from the fog up to `distance_m`, without a pane: S pi alpha / L (E2(2
/// alpha R0) / R0 - E2(2 alpha R) / R). E2 is the exponential integral, R0 the overlap distance.
double fog_events(const Fog& fog, double signal_events_1m, double distance_m);

}  // namespace dtof
