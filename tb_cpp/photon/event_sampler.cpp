// SPDX-License-Identifier: Apache-2.0
#include "photon/event_sampler.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/math/special_functions/erf.hpp>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <numbers>

#include "photon/physics.hpp"

namespace dtof {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Before a process's first event, in front of its list.
constexpr double kBeforeFrame = -1.0;
constexpr std::size_t kFirst = 1;

// Drawing the kept events one after the other in time order costs as much as drawing and sorting this many
// signal events, or four times as many background events, which come sorted (measured).
constexpr double kDenseSignal = 6.0;
constexpr double kDenseBackground = 24.0;
// Sorting while drawing is quadratic in the events of one pulse.
constexpr double kSortWhileDrawing = 16.0;
// A pulse whose centre is this many sigma outside the gate sends nothing into it (probability below 1e-32).
constexpr double kNegligibleSigma = 12.0;

/// 64 bits a call, so that Boost's ziggurats fill a double's mantissa from one word. One per pixel.
class Bits64 {
 public:
  using result_type = std::uint64_t;
  explicit Bits64(CounterRandom& random) : random_(random) {}
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }
  result_type operator()() {
    if (next_ == words_.size()) {
      random_.fill(words_);
      next_ = 0;
    }
    return words_[next_++];
  }

 private:
  CounterRandom& random_;
  std::array<std::uint64_t, 32> words_{};
  std::size_t next_ = words_.size();
};

double draw_exponential(Bits64& bits) { return boost::random::exponential_distribution<double>(1.0)(bits); }
/// In [0, 1).
double draw_uniform(Bits64& bits) { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
double draw_normal(Bits64& bits) { return boost::random::normal_distribution<double>(0.0, 1.0)(bits); }

/// Inverse of erfc without Boost's detour over long double.
double erfc_inverse(double value) {
  using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  return boost::math::erfc_inv(value, Policy());
}

/// First event after `now` (units of sigma from the pulse's centre) of a pulse of `events` mean events;
/// `gap` is exponential with mean 1. Time change of the Poisson process: events * Phi(t) rises by `gap`.
double next_in_pulse(double now, double events, double gap) {
  const double step = gap / events;
  // Each half uses the tail that keeps its relative precision.
  if (now < 0.0) {
    const double below = 0.5 * std::erfc(-now / std::numbers::sqrt2) + step;
    if (below < 0.5) {
      return -std::numbers::sqrt2 * erfc_inverse(2.0 * std::max(below, std::numeric_limits<double>::min()));
    }
    return below < 1.0 ? std::numbers::sqrt2 * erfc_inverse(2.0 * (1.0 - below)) : kNever;
  }
  const double above = 0.5 * std::erfc(now / std::numbers::sqrt2) - step;
  return above > 0.0 ? std::numbers::sqrt2 * erfc_inverse(2.0 * above) : kNever;
}

/// First event after `now` (from the response's centroid) of a measured pulse; `share` of the pulse lies
/// between.
double next_in_response(const PulseResponse& response, double now, double share) {
  const double before = response.share_before(now) + share;
  return before < 1.0 ? response.quantile(before) : kNever;
}

void make_room(std::vector<double>& values, std::size_t count) {
  if (count == values.size()) {
    values.resize(std::max<std::size_t>(1024, 2 * count));
  }
}

}  // namespace

EventSampler::EventSampler(const SensorModel& model, std::size_t keep)
    : code_count_(std::ldexp(1.0, model.np)),
      acquisitions_(model.acquisitions),
      frame_end_(acquisitions_ * code_count_),
      gate_begin_(model.time_gate ? model.time_gate->begin_s / model.time_resolution_s() : 0.0),
      gate_end_(model.time_gate ? model.time_gate->end_s / model.time_resolution_s() : code_count_),
      sigma_(model.pulse_sigma_s() / model.time_resolution_s()),
      dead_time_(model.dead_time_s / model.time_resolution_s()),
      response_(model.pulse_response_bins()),
      afterpulse_probability_(model.afterpulse_probability),
      afterpulse_time_constant_(model.afterpulse_time_constant_s / model.time_resolution_s()),
      keep_(keep),
      background_{kBeforeFrame},
      signal_{kBeforeFrame} {}

std::span<const double> EventSampler::sample(const PixelRates& rates, CounterRandom random) {
  PixelRates visible = rates;
  const double pulse_begin = response_ ? response_->begin() : -kNegligibleSigma * sigma_;
  const double pulse_end = response_ ? response_->end() : kNegligibleSigma * sigma_;
  if (gate_begin_ - rates.centre_bins > pulse_end || rates.centre_bins - gate_end_ > -pulse_begin) {
    visible.signal = 0.0;
  }
  const double background = rates.background * (gate_end_ - gate_begin_) / code_count_;
  if (keep_ != kAll && visible.signal / kDenseSignal + background / kDenseBackground > 1.0) {
    walk_in_time_order(visible, background, random);
  } else {
    walk_background(background, random);
    walk_signal(visible, random);
    merge();
    if (afterpulse_probability_ > 0.0) {
      follow_with_afterpulses(random);
    } else if (dead_time_ > 0.0) {
      drop_in_dead_time();
    }
  }
  return std::span<const double>(events_).first(event_count_);
}

[[gnu::flatten]] void EventSampler::walk_background(double events_per_acquisition, CounterRandom& random) {
  Bits64 bits(random);
  background_end_ = kFirst;
  // `walked` is measured in mean events: gaps are exponential with mean 1, whatever the rate.
  const double end = events_per_acquisition * acquisitions_;
  const double gate_width = gate_end_ - gate_begin_;
  const bool gated = gate_width < code_count_;
  const double acquisitions_per_event = 1.0 / events_per_acquisition;
  const double bins_per_event = code_count_ / events_per_acquisition;
  double walked = 0.0;
  while ((walked += draw_exponential(bits)) < end) {
    double position = walked * bins_per_event;
    if (gated) {
      const double acquisition = std::floor(walked * acquisitions_per_event);
      position = acquisition * code_count_ + gate_begin_ +
                 (walked * acquisitions_per_event - acquisition) * gate_width;
    }
    if (position >= frame_end_) {  // only by rounding
      break;
    }
    make_room(background_, background_end_);
    background_[background_end_++] = position;
  }
}

[[gnu::flatten]] void EventSampler::walk_signal(const PixelRates& rates, CounterRandom& random) {
  Bits64 bits(random);
  signal_end_ = kFirst;
  const double acquisitions_per_event = 1.0 / rates.signal;
  const double end = rates.signal * acquisitions_;
  const bool sort_now = rates.signal <= kSortWhileDrawing;
  double walked = 0.0;
  while ((walked += draw_exponential(bits)) < end) {
    const double acquisition = std::floor(walked * acquisitions_per_event);
    const double time = rates.centre_bins +
                        (response_ ? response_->quantile(draw_uniform(bits)) : sigma_ * draw_normal(bits));
    const double position = acquisition * code_count_ + time;
    if (time < gate_begin_ || time >= gate_end_ || position >= frame_end_) {
      continue;
    }
    make_room(signal_, signal_end_);
    std::size_t slot = signal_end_++;
    for (; sort_now && signal_[slot - 1] > position; --slot) {
      signal_[slot] = signal_[slot - 1];
    }
    signal_[slot] = position;
  }
  if (!sort_now) {
    std::sort(signal_.begin() + kFirst, signal_.begin() + static_cast<std::ptrdiff_t>(signal_end_));
  }
}

void EventSampler::merge() {
  make_room(background_, background_end_);
  make_room(signal_, signal_end_);
  background_[background_end_] = kNever;
  signal_[signal_end_] = kNever;
  event_count_ = background_end_ + signal_end_ - 2 * kFirst;
  if (events_.size() < event_count_) {
    events_.resize(event_count_);
  }
  // From both ends at once, two chains that the processor overlaps; without branches, since which process is
  // next is not predictable; as integers, which order like the numbers and are compared faster.
  const auto before = [](const double* a, const double* b) {
    return std::bit_cast<std::int64_t>(*a) < std::bit_cast<std::int64_t>(*b);
  };
  const double* background = &background_[kFirst];
  const double* signal = &signal_[kFirst];
  const double* last_background = &background_[background_end_] - 1;
  const double* last_signal = &signal_[signal_end_] - 1;
  const auto merge_last = [&](std::size_t place) {
    const bool take_background = before(last_signal, last_background);
    events_[place] = take_background ? *last_background : *last_signal;
    last_background -= take_background ? 1 : 0;
    last_signal -= take_background ? 0 : 1;
  };
  const std::size_t half = event_count_ / 2;
  for (std::size_t i = 0; i < half; ++i) {
    const bool take_signal = before(signal, background);
    events_[i] = take_signal ? *signal : *background;
    signal += take_signal ? 1 : 0;
    background += take_signal ? 0 : 1;
    merge_last(event_count_ - 1 - i);
  }
  if (event_count_ % 2 != 0) {
    merge_last(half);
  }
}

void EventSampler::walk_in_time_order(const PixelRates& rates, double background, CounterRandom& random) {
  Bits64 bits(random);
  event_count_ = 0;
  const double bins_per_background = (gate_end_ - gate_begin_) / background;
  for (std::uint32_t acquisition = 0; acquisition < acquisitions_; ++acquisition) {
    double now = gate_begin_;
    afterpulses_.clear();
    for (std::size_t kept = 0; kept < keep_; ++kept) {
      // Both processes are memoryless, so they may be restarted at any time.
      double next = background > 0.0 ? now + bins_per_background * draw_exponential(bits) : kNever;
      if (rates.signal > 0.0) {
        const double gap = draw_exponential(bits);
        const double in_pulse =
            response_ ? next_in_response(*response_, now - rates.centre_bins, gap / rates.signal)
                      : sigma_ * next_in_pulse((now - rates.centre_bins) / sigma_, rates.signal, gap);
        next = std::min(next, std::max(now, rates.centre_bins + in_pulse));
      }
      if (afterpulse_probability_ > 0.0) {
        std::erase_if(afterpulses_, [now](double time) { return time < now; });  // in the dead time
        const auto first = std::ranges::min_element(afterpulses_);
        if (first != afterpulses_.end() && *first < next) {
          next = *first;
          afterpulses_.erase(first);
        }
      }
      const double position = acquisition * code_count_ + next;
      if (next >= gate_end_ || position >= frame_end_) {
        break;
      }
      make_room(events_, event_count_);
      events_[event_count_++] = position;
      now = next + dead_time_;
      if (afterpulse_probability_ > 0.0 && draw_uniform(bits) < afterpulse_probability_) {
        afterpulses_.push_back(now + afterpulse_time_constant_ * draw_exponential(bits));
      }
    }
  }
}

void EventSampler::drop_in_dead_time() {
  std::size_t kept = 0;
  double dead_until = -1.0;
  for (std::size_t i = 0; i < event_count_; ++i) {
    const double position = events_[i];
    if (position < dead_until) {
      continue;
    }
    events_[kept++] = position;
    // The pause between two acquisitions is much longer than any dead time.
    const double acquisition_end = (std::floor(position / code_count_) + 1.0) * code_count_;
    dead_until = std::min(position + dead_time_, acquisition_end);
  }
  event_count_ = kept;
}

void EventSampler::follow_with_afterpulses(CounterRandom& random) {
  Bits64 bits(random);
  counted_.clear();
  afterpulses_.clear();
  double dead_until = -1.0;
  for (std::size_t i = 0; i < event_count_ || !afterpulses_.empty();) {
    const auto first = std::ranges::min_element(afterpulses_);
    const bool photon = first == afterpulses_.end() || (i < event_count_ && events_[i] <= *first);
    const double position = photon ? events_[i] : *first;
    if (photon) {
      ++i;
    } else {
      afterpulses_.erase(first);
    }
    if (position < dead_until) {
      continue;
    }
    counted_.push_back(position);
    const double acquisition_begin = std::floor(position / code_count_) * code_count_;
    dead_until = std::min(position + dead_time_, acquisition_begin + code_count_);
    if (draw_uniform(bits) < afterpulse_probability_) {
      const double next = position + dead_time_ + afterpulse_time_constant_ * draw_exponential(bits);
      if (next < std::min(acquisition_begin + gate_end_, frame_end_)) {
        afterpulses_.push_back(next);
      }
    }
  }
  event_count_ = counted_.size();
  std::swap(events_, counted_);
}

}  // namespace dtof
