// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/return_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "dtof/photon/bits64.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {
namespace {

// Pulses of the other laser whose centre is this many sigma outside the range send nothing into it.
constexpr double kOutsideSigma = 12.0;
// Distance beyond which no light returns in any range that a sensor may have (1e6 ns).
constexpr double kFarthest_m = 1e6;

double sigma_bins(double fwhm_s, double jitter_fwhm_s, double resolution_s) {
  return std::hypot(pulse_sigma_s(fwhm_s), pulse_sigma_s(jitter_fwhm_s)) / resolution_s;
}

}  // namespace

/// The events of one return after the other, each in time order behind those before.
class ReturnSampler::Walk {
 public:
  Walk(const ReturnSampler& sampler, CounterRandom& random, std::vector<double>& positions)
      : sampler_(sampler), bits_(random), positions_(positions), begin_(positions.size()) {}

  /// Calls `event(n)` for each event of a process with this many mean events in each of `pulses` pulses.
  template <typename Event>
  void each(double events, std::size_t pulses, const Event& event) {
    start_return();
    if (!(events > 0.0)) {
      return;
    }
    const double end = events * static_cast<double>(pulses);
    const double pulses_per_event = 1.0 / events;
    for (double walked = draw_exponential(bits_); walked < end; walked += draw_exponential(bits_)) {
      event(std::min(static_cast<std::size_t>(walked * pulses_per_event), pulses - 1));
    }
  }

  /// Calls `event(acquisition)` for each event of a process with this many mean events in each pulse of the
  /// frame. If the camera moves, only events of the part of the pixel that shows `look_at`'s pixel remain.
  template <typename Event>
  void each_pulse(double events, const Event& event) {
    if (seen_ == nullptr) {
      each(events, sampler_.acquisitions_,
           [&](std::size_t pulse) { event(static_cast<std::uint32_t>(pulse)); });
      return;
    }
    each(events * seen_->largest_share, seen_->end - seen_->first, [&](std::size_t pulse) {
      const auto acquisition = seen_->first + static_cast<std::uint32_t>(pulse);
      if (happens(seen_share(sampler_.around_.lateral, *seen_, acquisition, sampler_.acquisitions_) /
                  seen_->largest_share)) {
        event(acquisition);
      }
    });
  }
  /// Null: the pixel's own scene in every pulse.
  void look_at(const SeenPixel* seen) { seen_ = seen; }

  /// An event of probability `share`.
  bool happens(double share) { return share >= 1.0 || draw_uniform(bits_) < share; }
  double uniform() { return draw_uniform(bits_); }
  /// From the pulse's centroid.
  double own_deviation() {
    return sampler_.response_ ? sampler_.response_->quantile(draw_uniform(bits_))
                              : sampler_.sigma_ * draw_normal(bits_);
  }
  double other_deviation() { return sampler_.other_sigma_ * draw_normal(bits_); }

  void add(std::uint32_t acquisition, double time) {
    const double position = acquisition * sampler_.code_count_ + time;
    if (!(time >= sampler_.gate_begin_ && time < sampler_.gate_end_) ||
        position >= sampler_.acquisitions_ * sampler_.code_count_) {
      return;
    }
    positions_.push_back(position);
    std::size_t slot = positions_.size() - 1;
    for (; slot > begin_ && positions_[slot - 1] > position; --slot) {
      positions_[slot] = positions_[slot - 1];
    }
    positions_[slot] = position;
  }

  void finish() { start_return(); }

 private:
  void start_return() {
    const auto begin = static_cast<std::ptrdiff_t>(first_);
    const auto middle = static_cast<std::ptrdiff_t>(begin_);
    std::inplace_merge(positions_.begin() + begin, positions_.begin() + middle, positions_.end());
    begin_ = positions_.size();
  }

  const ReturnSampler& sampler_;
  Bits64 bits_;
  std::vector<double>& positions_;
  std::size_t first_ = 0;
  std::size_t begin_;  // of this return's events
  const SeenPixel* seen_ = nullptr;
};

ReturnSampler::ReturnSampler(const SensorModel& model)
    : around_(model.surroundings),
      signal_changes_(around_.signal_changes()),
      code_count_(std::ldexp(1.0, model.np)),
      acquisitions_(model.acquisitions),
      gate_begin_(model.time_gate ? model.time_gate->begin_s / model.time_resolution_s() : 0.0),
      gate_end_(model.time_gate ? model.time_gate->end_s / model.time_resolution_s() : code_count_),
      sigma_(model.pulse_sigma_s() / model.time_resolution_s()),
      other_sigma_(sigma_bins(
          around_.other_laser.pulse_fwhm_s > 0.0 ? around_.other_laser.pulse_fwhm_s : model.pulse_fwhm_s,
          model.jitter_fwhm_s, model.time_resolution_s())),
      response_(model.pulse_response_bins()),
      pulse_fwhm_s_(model.pulse_fwhm_s),
      time_resolution_s_(model.time_resolution_s()),
      signal_events_1m_(model.signal_events_1m),
      metres_per_pulse_(around_.motion.velocity_m_per_s * model.pulse_period()),
      seen_(seen_pixels(around_.lateral, acquisitions_)) {
  const LaserSettling& settling = around_.settling;
  if (settling.silent_share != 0.0 || settling.power_drop != 0.0 || settling.power_drift != 0.0) {
    for (std::uint32_t i = 0; i < acquisitions_; ++i) {
      powers_.push_back(settling.power(i, acquisitions_));
    }
    highest_power_ = std::ranges::max(powers_);
  }
  if (settling.delay_s != 0.0) {
    for (std::uint32_t i = 0; i < acquisitions_; ++i) {
      delays_bins_.push_back(settling.delay(i, acquisitions_) / time_resolution_s_);
    }
  }
  list_arrivals(model);
}

void ReturnSampler::list_arrivals(const SensorModel& model) {
  const OtherLaser& laser = around_.other_laser;
  if (laser.events == 0.0) {
    return;
  }
  const double own_period = model.pulse_period();
  const double period = own_period / (1.0 + laser.rate_offset);
  const std::vector<double> offsets = around_.firing_offsets.delays(acquisitions_);
  const double margin = kOutsideSigma * other_sigma_;
  for (std::uint32_t acquisition = 0; acquisition < acquisitions_; ++acquisition) {
    const double start = acquisition * own_period + (offsets.empty() ? 0.0 : offsets[acquisition]);
    // Pulse n arrives at first_arrival + n period: all that touch the range.
    const double earliest = start - margin * time_resolution_s_ - laser.first_arrival_s;
    for (double n = std::ceil(earliest / period);; n += 1.0) {
      const double centre = (laser.first_arrival_s + n * period - start) / time_resolution_s_;
      if (!(centre < code_count_ + margin)) {
        break;
      }
      arrivals_.push_back({acquisition, centre});
    }
  }
}

double ReturnSampler::arrival_bins(double distance_m) const {
  return arrival_centre_s(distance_m, pulse_fwhm_s_) / time_resolution_s_;
}

void ReturnSampler::draw(const PixelReturns& returns, CounterRandom& random,
                         std::vector<double>& positions) const {
  positions.clear();
  if (returns.dead) {
    return;
  }
  Walk walk(*this, random, positions);
  if (signal_changes_) {
    draw_target(returns, walk);
  }
  draw_surface(around_.cover_glass.distance_m, around_.cover_glass.events, returns.skew_bins, walk);
  draw_pane(returns, walk);
  draw_fog(returns, walk);
  draw_other_laser(returns.skew_bins, walk);
  walk.finish();
}

void ReturnSampler::draw(const MovingReturns& returns, CounterRandom& random,
                         std::vector<double>& positions) const {
  positions.clear();
  if (returns.own.dead) {
    return;
  }
  Walk walk(*this, random, positions);
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    walk.look_at(&seen_[i]);
    draw_sunlight(returns.seen[i].rates.background, walk);
    draw_target(returns.seen[i], walk);
    draw_pane(returns.seen[i], walk);
    draw_fog(returns.seen[i], walk);
  }
  walk.look_at(nullptr);
  draw_surface(around_.cover_glass.distance_m, around_.cover_glass.events, returns.own.skew_bins, walk);
  draw_other_laser(returns.own.skew_bins, walk);
  walk.finish();
}

void ReturnSampler::draw_sunlight(double events, Walk& walk) const {
  const double width = gate_end_ - gate_begin_;
  walk.each_pulse(events * width / code_count_, [&](std::uint32_t acquisition) {
    walk.add(acquisition, gate_begin_ + walk.uniform() * width);
  });
}

void ReturnSampler::draw_pane(const PixelReturns& returns, Walk& walk) const {
  const Pane& pane = around_.pane;
  if (pane.distance_m > 0.0 && !(returns.distance_m > 0.0 && returns.distance_m <= pane.distance_m)) {
    double share = 1.0;
    if (around_.fog.extinction_per_m > 0.0) {
      share = std::exp(-2.0 * around_.fog.extinction_per_m * pane.distance_m);
    }
    draw_surface(pane.distance_m,
                 share * signal_events_1m_ * pane.reflectivity / pane.distance_m / pane.distance_m,
                 returns.skew_bins, walk);
  }
}

void ReturnSampler::draw_target(const PixelReturns& returns, Walk& walk) const {
  if (!(returns.distance_m > 0.0) && returns.light.none()) {
    return;
  }
  const double middle = 0.5 * (acquisitions_ - 1.0);
  const double extinction = around_.fog.extinction_per_m;
  // Signal over that at the frame's middle.
  const auto strength = [&](double distance) {
    const double ratio = returns.distance_m / distance;
    return ratio * ratio * std::exp(2.0 * extinction * (returns.distance_m - distance));
  };
  const double nearest = returns.distance_m - std::abs(metres_per_pulse_) * middle;
  const double highest = metres_per_pulse_ == 0.0 ? 1.0 : strength(nearest);
  walk.each_pulse(returns.rates.signal * highest * highest_power_, [&](std::uint32_t acquisition) {
    double centre = returns.light.none() ? returns.rates.centre_bins : returns.light.quantile(walk.uniform());
    centre += delay_bins(acquisition);
    double share = power(acquisition) / highest_power_;
    if (metres_per_pulse_ != 0.0) {
      const double moved = metres_per_pulse_ * (acquisition - middle);
      share *= strength(returns.distance_m + moved) / highest;
      centre += arrival_bins(moved) - arrival_bins(0.0);
    }
    if (walk.happens(share)) {
      walk.add(acquisition, centre + walk.own_deviation());
    }
  });
}

void ReturnSampler::draw_surface(double distance_m, double events, double skew_bins, Walk& walk) const {
  const double centre = arrival_bins(distance_m) + skew_bins;
  walk.each_pulse(events * highest_power_, [&](std::uint32_t acquisition) {
    if (walk.happens(power(acquisition) / highest_power_)) {
      walk.add(acquisition, centre + delay_bins(acquisition) + walk.own_deviation());
    }
  });
}

void ReturnSampler::draw_fog(const PixelReturns& returns, Walk& walk) const {
  const Fog& fog = around_.fog;
  const Pane& pane = around_.pane;
  const double end = returns.distance_m > 0.0 ? returns.distance_m : kFarthest_m;
  if (fog.extinction_per_m == 0.0 || end <= fog.overlap_m) {
    return;
  }
  // Without extinction and pane the density falls with the distance squared: that is drawn, and thinned.
  const double per_near = 1.0 / fog.overlap_m;
  const double per_range = per_near - 1.0 / end;
  const double near_share = std::exp(-2.0 * fog.extinction_per_m * fog.overlap_m);
  const double events = signal_events_1m_ * std::numbers::pi * fog.extinction_per_m / fog.lidar_ratio_sr *
                        per_range * near_share;
  const double behind_pane = pane.transmittance * pane.transmittance;
  walk.each_pulse(events * highest_power_, [&](std::uint32_t acquisition) {
    const double distance = 1.0 / (per_near - walk.uniform() * per_range);
    double share = std::exp(-2.0 * fog.extinction_per_m * (distance - fog.overlap_m)) * power(acquisition) /
                   highest_power_;
    if (pane.distance_m > 0.0 && distance > pane.distance_m) {
      share *= behind_pane;
    }
    if (walk.happens(share)) {
      walk.add(acquisition,
               arrival_bins(distance) + returns.skew_bins + delay_bins(acquisition) + walk.own_deviation());
    }
  });
}

void ReturnSampler::draw_other_laser(double skew_bins, Walk& walk) const {
  walk.each(around_.other_laser.events, arrivals_.size(), [&](std::size_t index) {
    const Arrival& arrival = arrivals_[index];
    walk.add(arrival.acquisition, arrival.centre_bins + skew_bins + walk.other_deviation());
  });
}

}  // namespace dtof
