// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/event_sampler.hpp"

#include <algorithm>
#include <bit>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <cstring>
#include <numbers>

#include "dtof/photon/bits64.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/photon/ziggurat.hpp"

namespace dtof {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// Before a process's first event, twice in front of its list.
constexpr double kBeforeFrame = -kNever;
constexpr std::size_t kFirst = 2;

// Drawing the kept events one after the other in time order costs as much as drawing and sorting this many
// signal events, or four times as many background events, which come sorted (measured).
constexpr double kDenseSignal = 6.0;
constexpr double kDenseBackground = 24.0;
// Sorting while drawing is quadratic in the events of one pulse.
constexpr double kSortWhileDrawing = 16.0;
// A pulse whose centre is this many sigma outside the gate sends nothing into it (probability below 1e-32).
constexpr double kNegligibleSigma = 12.0;

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
  if (count > values.size()) {
    values.resize(std::max<std::size_t>(1024, 2 * count));
  }
}

/// The whole part of a number >= 0 below 2^63.
double whole(double number) { return static_cast<double>(static_cast<std::int64_t>(number)); }

std::int64_t load_integer(const double* number) {
  std::int64_t integer = 0;
  std::memcpy(&integer, number, sizeof(integer));
  return integer;
}
void store_integer(std::int64_t integer, double* number) { std::memcpy(number, &integer, sizeof(integer)); }

/// Merges two sorted lists from a place in each on, an event a step.
class TwoListsForward {
 public:
  TwoListsForward(const double* signal, const double* background, double* events)
      : signal_(signal), background_(background), events_(events) {}
  void step() {
    const std::int64_t signal = load_integer(signal_);
    const std::int64_t background = load_integer(background_);
    const std::int64_t behind = signal - background;
    const std::int64_t earlier = behind >> 63;  // -1: the signal
    store_integer(background + (behind & earlier), events_++);
    signal_ -= earlier;
    background_ += 1 + earlier;
  }

 private:
  const double* signal_;
  const double* background_;
  double* events_;
};

/// The same of what lies before a place in each, from the last event on.
class TwoListsBackward {
 public:
  TwoListsBackward(const double* signal, const double* background, double* events)
      : signal_(signal - 1), background_(background - 1), events_(events) {}
  void step() {
    const std::int64_t signal = load_integer(signal_);
    const std::int64_t background = load_integer(background_);
    const std::int64_t behind = signal - background;
    const std::int64_t earlier = behind >> 63;
    store_integer(signal - (behind & earlier), --events_);
    background_ += earlier;
    signal_ -= 1 + earlier;
  }

 private:
  const double* signal_;
  const double* background_;
  double* events_;
};

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
      returns_(model.surroundings.none() ? nullptr : std::make_shared<const ReturnSampler>(model)),
      background_{kBeforeFrame, kBeforeFrame},
      signal_{kBeforeFrame, kBeforeFrame} {}

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
    lose_and_add(random);
  }
  return std::span<const double>(events_).first(event_count_);
}

std::span<const double> EventSampler::sample(double background, const TransientLight& light,
                                             CounterRandom random) {
  walk_background(background * (gate_end_ - gate_begin_) / code_count_, random);
  walk_light(light, random);
  merge();
  lose_and_add(random);
  return std::span<const double>(events_).first(event_count_);
}

std::span<const double> EventSampler::sample(const PixelReturns& returns, CounterRandom random,
                                             CounterRandom further) {
  walk_background(returns.rates.background * (gate_end_ - gate_begin_) / code_count_, random);
  signal_end_ = kFirst;
  if (!returns_->signal_changes()) {
    if (returns.light.none()) {
      walk_signal(returns.rates, random);
    } else {
      walk_light(returns.light, random);
    }
  }
  returns_->draw(returns, further, further_);
  return with_further(random);
}

std::span<const double> EventSampler::sample(const MovingReturns& returns, CounterRandom random,
                                             CounterRandom further) {
  walk_background(returns.own.rates.background * (gate_end_ - gate_begin_) / code_count_, random);
  signal_end_ = kFirst;
  returns_->draw(returns, further, further_);
  return with_further(random);
}

std::span<const SeenPixel> EventSampler::seen() const {
  return returns_ ? std::span<const SeenPixel>(returns_->seen()) : std::span<const SeenPixel>();
}

/// The events of all processes together, after losses.
std::span<const double> EventSampler::with_further(CounterRandom& random) {
  make_room(merged_, signal_end_ + further_.size());
  const auto merged = std::merge(signal_.begin(), signal_.begin() + static_cast<std::ptrdiff_t>(signal_end_),
                                 further_.begin(), further_.end(), merged_.begin());
  signal_end_ = static_cast<std::size_t>(merged - merged_.begin());
  std::swap(signal_, merged_);
  merge();
  lose_and_add(random);
  return std::span<const double>(events_).first(event_count_);
}

void EventSampler::lose_and_add(CounterRandom& random) {
  if (afterpulse_probability_ > 0.0) {
    follow_with_afterpulses(random);
  } else if (dead_time_ > 0.0) {
    drop_in_dead_time();
  }
}

void EventSampler::walk_background(double events_per_acquisition, CounterRandom& random) {
  background_end_ = kFirst;
  // `walked` is measured in mean events: gaps are exponential with mean 1, whatever the rate.
  const double end = events_per_acquisition * acquisitions_;
  const double gate_begin = gate_begin_;
  const double gate_width = gate_end_ - gate_begin_;
  const double code_count = code_count_;
  const double acquisitions_per_event = 1.0 / events_per_acquisition;
  const double bins_per_event = code_count_ / events_per_acquisition;
  if (gate_width < code_count_) {
    walk_flat(end, random, [=](double walked) {
      const double acquisition = whole(walked * acquisitions_per_event);
      return acquisition * code_count + gate_begin +
             (walked * acquisitions_per_event - acquisition) * gate_width;
    });
  } else {
    walk_flat(end, random, [=](double walked) { return walked * bins_per_event; });
  }
}

template <typename PositionAt>
void EventSampler::walk_flat(double end, CounterRandom& random, const PositionAt& position_at) {
  Bits64 bits(random);
  const Ziggurat& exponential = Ziggurat::exponential();
  const double frame_end = frame_end_;
  double walked = 0.0;
  for (bool inside = true; inside;) {
    const auto words = bits.batch();
    make_room(background_, background_end_ + Bits64::kBatch + 1);
    double* event = &background_[background_end_];
    const auto keep = [&] {
      inside = walked < end;
      if (inside) {
        *event = position_at(walked);
        inside = *event < frame_end;  // fails by rounding only
        event += inside ? 1 : 0;
      }
    };
    std::size_t i = bits.next();
    for (; i < Bits64::kBatch && inside; ++i) {
      const Ziggurat::Draw gap = exponential.draw(words[i]);
      if (!gap.decided) {
        break;
      }
      walked += gap.value;
      keep();
    }
    bits.skip_to(i);
    if (i < Bits64::kBatch && inside) {
      walked += draw_exponential(bits);
      keep();
    }
    background_end_ = static_cast<std::size_t>(event - background_.data());
  }
}

void EventSampler::walk_signal(const PixelRates& rates, CounterRandom& random) {
  const Ziggurat& normal = Ziggurat::normal();
  const double centre = rates.centre_bins;
  const double sigma = sigma_;
  walk_pulses<2>(
      rates.signal, !response_, random,
      [&normal, centre, sigma](const std::uint64_t* words) {
        const Ziggurat::Draw deviation = normal.draw(words[0]);
        return Ziggurat::Draw{centre + sigma * deviation.value, deviation.decided};
      },
      [this, centre, sigma](Bits64& bits) {
        return centre + (response_ ? response_->quantile(draw_uniform(bits)) : sigma * draw_normal(bits));
      });
}

void EventSampler::walk_light(const TransientLight& light, CounterRandom& random) {
  if (light.none()) {
    signal_end_ = kFirst;
    return;
  }
  const Ziggurat& normal = Ziggurat::normal();
  const double sigma = sigma_;
  walk_pulses<3>(
      light.events(), !response_, random,
      [&normal, light, sigma](const std::uint64_t* words) {
        const Ziggurat::Draw deviation = normal.draw(words[0]);
        return Ziggurat::Draw{light.quantile(uniform_of(words[1])) + sigma * deviation.value,
                              deviation.decided};
      },
      [this, light, sigma](Bits64& bits) {
        const double deviation =
            response_ ? response_->quantile(draw_uniform(bits)) : sigma * draw_normal(bits);
        return light.quantile(draw_uniform(bits)) + deviation;
      });
}

/// Walks all pulses. An event takes kWords words: one for its gap, the others for `fast_time`, if it decides.
template <std::size_t kWords, typename Fast, typename Slow>
void EventSampler::walk_pulses(double events, bool fast, CounterRandom& random, const Fast& fast_time,
                               const Slow& slow_time) {
  Bits64 bits(random);
  const Ziggurat& exponential = Ziggurat::exponential();
  signal_end_ = kFirst;
  const double acquisitions_per_event = 1.0 / events;
  const double end = events * acquisitions_;
  const double gate_begin = gate_begin_;
  const double gate_end = gate_end_;
  const double frame_end = frame_end_;
  const double code_count = code_count_;
  const bool sort_now = events <= kSortWhileDrawing;
  double walked = 0.0;
  for (bool inside = true; inside;) {
    const auto words = bits.batch();
    make_room(signal_, signal_end_ + Bits64::kBatch + 1);
    double* event = &signal_[signal_end_];
    const auto keep = [&](double time) {
      const double position = whole(walked * acquisitions_per_event) * code_count + time;
      if (time < gate_begin || time >= gate_end || position >= frame_end) {
        return;
      }
      // Two events of a pulse come in either order as often, so that this exchange has no branch.
      const double last = event[-1];
      const double before = std::min(last, position);
      event[-1] = before;
      event[0] = std::max(last, position);
      if (before < event[-2] && sort_now) {
        double* slot = event - 1;
        for (; slot[-1] > before; --slot) {
          *slot = slot[-1];
        }
        *slot = before;
      }
      ++event;
    };
    std::size_t i = bits.next();
    for (; i + kWords - 1 < Bits64::kBatch && fast; i += kWords) {
      const Ziggurat::Draw gap = exponential.draw(words[i]);
      const Ziggurat::Draw time = fast_time(&words[i + 1]);
      if (!(gap.decided & time.decided)) {
        break;
      }
      walked += gap.value;
      if (walked >= end) {
        inside = false;
        break;
      }
      keep(time.value);
    }
    bits.skip_to(i);
    if (i < Bits64::kBatch && inside) {
      walked += draw_exponential(bits);
      inside = walked < end;
      if (inside) {
        keep(slow_time(bits));
      }
    }
    signal_end_ = static_cast<std::size_t>(event - signal_.data());
  }
  if (!sort_now) {
    std::sort(signal_.begin() + kFirst, signal_.begin() + static_cast<std::ptrdiff_t>(signal_end_));
  }
}

void EventSampler::merge() {
  make_room(background_, background_end_ + 1);
  make_room(signal_, signal_end_ + 1);
  background_[background_end_] = kNever;
  signal_[signal_end_] = kNever;
  const std::size_t backgrounds = background_end_ - kFirst;
  const std::size_t signals = signal_end_ - kFirst;
  event_count_ = backgrounds + signals;
  if (events_.size() < event_count_) {
    events_.resize(event_count_);
  }
  // From both ends and from a point between them at once, four chains that the processor overlaps; without
  // branches, since which process is next is not predictable; as integers, which order like the numbers and
  // are compared faster.
  const std::size_t quarter = event_count_ / 4;
  const std::size_t middle = 2 * quarter;
  std::size_t signals_before = middle - std::min(middle, backgrounds);  // the middle
  for (std::size_t most = std::min(middle, signals); signals_before < most;) {
    const std::size_t between = (signals_before + most) / 2;
    if (signal_[kFirst + between] < background_[kFirst + middle - 1 - between]) {
      signals_before = between + 1;
    } else {
      most = between;
    }
  }
  const double* middle_signal = &signal_[kFirst + signals_before];
  const double* middle_background = &background_[kFirst + middle - signals_before];
  double* events = events_.data();
  TwoListsForward first(&signal_[kFirst], &background_[kFirst], events);
  TwoListsBackward second(middle_signal, middle_background, events + middle);
  TwoListsForward third(middle_signal, middle_background, events + middle);
  TwoListsBackward fourth(&signal_[signal_end_], &background_[background_end_], events + event_count_);
  for (std::size_t i = 0; i < quarter; ++i) {
    first.step();
    second.step();
    third.step();
    fourth.step();
  }
  for (std::size_t i = 4 * quarter; i < event_count_; ++i) {
    fourth.step();
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
      make_room(events_, event_count_ + 1);
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
