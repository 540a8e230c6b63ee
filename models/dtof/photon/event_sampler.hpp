// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "dtof/core/pulse_response.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/return_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// Draws the events of one pixel over a frame, in time order. Keeps its buffers from pixel to pixel.
///
/// An event is a position on the frame's concatenated time axis in units of T_res: acquisition * 2^NP + t
/// with 0 <= t < 2^NP. So floor(position) holds acquisition and TDC code. Time gate and dead time are
/// applied, and afterpulses are included.
///
/// Both Poisson processes (signal and background) are walked by exponential gaps. So acquisitions without
/// events cost nothing, and the distribution is exact. Positions are rounded to 2^-52 of the frame.
class EventSampler {
 public:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  /// `keep`: number of first events of an acquisition that are needed; kAll: all.
  EventSampler(const SensorModel& model, std::size_t keep);

  /// Events of a pixel without surroundings. Valid until the next call.
  std::span<const double> sample(const PixelRates& rates, CounterRandom random);
  /// Events of a pixel with this background and the returns of a transient cube (arrival times in units of
  /// T_res), without surroundings. All events of an acquisition are returned, whatever `keep` is. Valid until
  /// the next call.
  std::span<const double> sample(double background, const TransientLight& light, CounterRandom random);
  /// Events of a pixel in surroundings; the sensor must have some (Surroundings::none is false). Additional
  /// returns are drawn from `further`. All events of an acquisition are returned, whatever `keep` is. Valid
  /// until the next call.
  std::span<const double> sample(const PixelReturns& returns, CounterRandom random, CounterRandom further);
  /// The same for a sensor that moves sideways.
  std::span<const double> sample(const MovingReturns& returns, CounterRandom random, CounterRandom further);
  /// Pixels of the scene that a pixel sees (ReturnSampler::seen).
  [[nodiscard]] std::span<const SeenPixel> seen() const;

 private:
  void walk_background(double events_per_acquisition, CounterRandom& random);
  template <typename PositionAt>
  void walk_flat(double end, CounterRandom& random, const PositionAt& position_at);
  void walk_signal(const PixelRates& rates, CounterRandom& random);
  void walk_light(const TransientLight& light, CounterRandom& random);
  template <std::size_t kWords, typename Fast, typename Slow>
  void walk_pulses(double events, bool fast, CounterRandom& random, const Fast& fast_time,
                   const Slow& slow_time);
  std::span<const double> with_further(CounterRandom& random);
  void merge();
  void walk_in_time_order(const PixelRates& rates, double background, CounterRandom& random);
  void lose_and_add(CounterRandom& random);
  void drop_in_dead_time();
  void follow_with_afterpulses(CounterRandom& random);

  double code_count_;
  std::uint32_t acquisitions_;
  double frame_end_;
  double gate_begin_;
  double gate_end_;
  double sigma_;
  double dead_time_;
  std::shared_ptr<const PulseResponse> response_;  // in units of T_res; null: a Gaussian of sigma_
  double afterpulse_probability_;
  double afterpulse_time_constant_;
  std::size_t keep_;
  std::shared_ptr<const ReturnSampler> returns_;  // null: no surroundings

  // Each process's events between two sentinels.
  std::vector<double> background_;
  std::vector<double> signal_;
  std::size_t background_end_ = 0;
  std::size_t signal_end_ = 0;
  std::vector<double> events_;
  std::vector<double> counted_;
  std::vector<double> afterpulses_;  // still to come in this acquisition
  std::size_t event_count_ = 0;
  std::vector<double> further_;
  std::vector<double> merged_;
};

}  // namespace dtof
