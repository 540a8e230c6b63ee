// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dtof/core/pulse_response.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/surroundings.hpp"
#include "dtof/photon/transient_cube.hpp"

namespace dtof {

struct SensorModel;

/// Mean events of one pixel, before any loss.
struct PixelRates {
  double background = 0.0;   ///< per T_int, flat in time
  double signal = 0.0;       ///< per pulse
  double centre_bins = 0.0;  ///< mean arrival time of the signal in units of T_res
};

/// Mean events of one pixel with surroundings.
struct PixelReturns {
  PixelRates rates;         ///< background and the target's return at the frame's middle, skew included
  double distance_m = 0.0;  ///< distance of the target at the frame's middle; 0: no target
  /// Returns of a transient cube, as arrival times in units of T_res; they take the target's place.
  TransientLight light;
  double skew_bins = 0.0;
  bool dead = false;
};

/// Mean events of a moving pixel: `own` has those that stay with the pixel, `seen` those of each pixel of the
/// scene (ReturnSampler::seen), whose background is sunlight alone.
struct MovingReturns {
  PixelReturns own;
  std::vector<PixelReturns> seen;
};

/// Draws the additional events of one pixel over a frame that its surroundings cause: cover glass, fog, pane
/// and other laser. If the target's return changes during the frame (Surroundings::signal_changes), it is
/// drawn here too.
///
/// Each return is a Poisson process over the frame's pulses. A rate that changes from pulse to pulse is drawn
/// at its maximum and thinned, which is exact.
class ReturnSampler {
 public:
  explicit ReturnSampler(const SensorModel& model);

  [[nodiscard]] bool signal_changes() const { return signal_changes_; }
  /// Pixels of the scene that a pixel sees; empty unless the camera moves sideways.
  [[nodiscard]] const std::vector<SeenPixel>& seen() const { return seen_; }
  /// Events inside the time gate, in time order, as positions (EventSampler).
  void draw(const PixelReturns& returns, CounterRandom& random, std::vector<double>& positions) const;
  /// The same for a sensor that moves sideways; includes the sunlight of the scene.
  void draw(const MovingReturns& returns, CounterRandom& random, std::vector<double>& positions) const;

 private:
  class Walk;
  /// A pulse of the other laser that arrives within an acquisition.
  struct Arrival {
    std::uint32_t acquisition;
    double centre_bins;
  };

  void list_arrivals(const SensorModel& model);
  [[nodiscard]] double arrival_bins(double distance_m) const;
  [[nodiscard]] double power(std::uint32_t acquisition) const {
    return powers_.empty() ? 1.0 : powers_[acquisition];
  }
  [[nodiscard]] double delay_bins(std::uint32_t acquisition) const {
    return delays_bins_.empty() ? 0.0 : delays_bins_[acquisition];
  }
  void draw_target(const PixelReturns& returns, Walk& walk) const;
  void draw_surface(double distance_m, double events, double skew_bins, Walk& walk) const;
  void draw_pane(const PixelReturns& returns, Walk& walk) const;
  void draw_fog(const PixelReturns& returns, Walk& walk) const;
  void draw_sunlight(double events, Walk& walk) const;
  void draw_other_laser(double skew_bins, Walk& walk) const;

  Surroundings around_;
  bool signal_changes_;
  double code_count_;
  std::uint32_t acquisitions_;
  double gate_begin_;
  double gate_end_;
  double sigma_;
  double other_sigma_;
  std::shared_ptr<const PulseResponse> response_;  // in units of T_res; null: a Gaussian of sigma_
  double pulse_fwhm_s_;
  double time_resolution_s_;
  double signal_events_1m_;
  double metres_per_pulse_;  // distance that a target moves from pulse to pulse
  double highest_power_ = 1.0;
  std::vector<double> powers_;       // power of each pulse relative to the settled one; empty: always 1
  std::vector<double> delays_bins_;  // delay of each pulse; empty: none
  std::vector<Arrival> arrivals_;
  std::vector<SeenPixel> seen_;
};

}  // namespace dtof
