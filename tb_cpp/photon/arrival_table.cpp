// SPDX-License-Identifier: Apache-2.0
#include "photon/arrival_table.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "photon/physics.hpp"

namespace dtof {
namespace {

constexpr double kReachSigmas = 6.0;
constexpr int kKnotsPerSigma = 8;
constexpr double kFlatKnots = 32.0;  // over the whole range

/// Share of a standard normal distribution below z.
double normal_share(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

bool same(const PixelRates& a, const PixelRates& b) {
  return a.background == b.background && a.signal == b.signal && a.centre_bins == b.centre_bins;
}

/// 1 - exp(-x); cheap where the steps between knots are small.
double one_minus_exp(double x) {
  constexpr double kSmall = 0.1;  // the series' first dropped term is below 2e-9 of the result
  return x < kSmall ? x * (1.0 - x * (1.0 / 2 - x * (1.0 / 6 - x * (1.0 / 24 - x * (1.0 / 120 - x / 720)))))
                    : -std::expm1(-x);
}

/// `some` = P(N >= 1).
double kept_events(double mean, double some, int slots) {
  // Sum of P(N > k) for k below `slots`; each is the one before less P(N = k).
  double more = some;
  double exactly = 1.0 - some;
  double kept = more;
  for (int k = 1; k < slots; ++k) {
    exactly *= mean / k;
    more = std::max(more - exactly, 0.0);
    kept += more;
  }
  return kept;
}

}  // namespace

double kept_events(double mean, int slots) { return kept_events(mean, -std::expm1(-mean), slots); }

double at_least(int k, double mean) {
  if (k <= 0) {
    return 1.0;
  }
  if (mean < k) {
    // The upper tail term by term: the complement would cancel.
    double term = std::exp(k * std::log(std::max(mean, std::numeric_limits<double>::min())) - mean -
                           std::lgamma(k + 1.0));
    double sum = 0.0;
    for (int n = k; term > sum * std::numeric_limits<double>::epsilon(); ++n) {
      sum += term;
      term *= mean / (n + 1.0);
    }
    return sum;
  }
  double exactly = std::exp(-mean);
  double less = exactly;
  for (int n = 1; n < k; ++n) {
    exactly *= mean / n;
    less += exactly;
  }
  return 1.0 - less;
}

ArrivalTable::ArrivalTable(const SensorModel& model)
    : code_count_(std::ldexp(1.0, model.np)),
      gate_begin_(model.time_gate ? model.time_gate->begin_s / model.time_resolution_s() : 0.0),
      gate_end_(model.time_gate ? model.time_gate->end_s / model.time_resolution_s() : code_count_),
      last_time_(std::nextafter(gate_end_, 0.0)),
      sigma_(pulse_sigma_s(model.pulse_fwhm_s) / model.time_resolution_s()),
      cells_(kCells) {
  const int half = static_cast<int>(kReachSigmas) * kKnotsPerSigma;
  for (int i = -half; i <= half; ++i) {
    const double z = static_cast<double>(i) / kKnotsPerSigma;
    pulse_offsets_.push_back(z * sigma_);
    pulse_shares_.push_back(normal_share(z));
  }
}

void ArrivalTable::add_knot(double time, double pulse_share) {
  const double mean = rates_.background * (time - gate_begin_) / code_count_ +
                      pulse_events_ * std::max(pulse_share - share_at_begin_, 0.0);
  if (slots_ == 0) {
    knots_.push_back({mean, time});
  } else {
    some_ += (1.0 - some_) * one_minus_exp(std::max(mean - events_, 0.0));
    knots_.push_back({kept_events(mean, some_, slots_), time});
  }
  events_ = mean;
}

void ArrivalTable::add_flat_knots(double from, double to, double pulse_share) {
  const double step = code_count_ / kFlatKnots;
  for (double time = from; time < to; time += step) {
    add_knot(time, pulse_share);
  }
}

void ArrivalTable::build(const PixelRates& rates, int slots) {
  if (slots == slots_ && same(rates, rates_)) {
    return;
  }
  rates_ = rates;
  slots_ = slots;
  place_knots(rates);
  total_ = knots_.back().cumulative;
  cells_per_event_ = total_ > 0.0 ? kCells / total_ : 0.0;
  if (total_ > 0.0) {
    fill_cells();
  }
}

void ArrivalTable::place_knots(const PixelRates& rates) {
  knots_.clear();
  events_ = 0.0;
  some_ = 0.0;
  share_at_begin_ = 0.0;
  const double pulse_begin = rates.centre_bins + pulse_offsets_.front();
  const double pulse_end = rates.centre_bins + pulse_offsets_.back();
  const bool pulse_visible = rates.signal > 0.0 && pulse_end > gate_begin_ && pulse_begin < gate_end_;
  pulse_events_ = pulse_visible ? rates.signal : 0.0;
  if (!pulse_visible) {
    add_flat_knots(gate_begin_, gate_end_, 0.0);
    add_knot(gate_end_, 0.0);
    return;
  }
  const auto share = [&](double time) { return normal_share((time - rates.centre_bins) / sigma_); };
  if (pulse_begin < gate_begin_) {
    share_at_begin_ = share(gate_begin_);
    add_knot(gate_begin_, share_at_begin_);
  } else {
    add_flat_knots(gate_begin_, pulse_begin, 0.0);
  }
  for (std::size_t i = 0; i < pulse_offsets_.size(); ++i) {
    const double time = rates.centre_bins + pulse_offsets_[i];
    if (time > gate_begin_ && time < gate_end_) {
      add_knot(time, pulse_shares_[i]);
    }
  }
  const bool cut = pulse_end > gate_end_;
  if (!cut) {
    add_flat_knots(pulse_end, gate_end_, 1.0);
  }
  add_knot(gate_end_, cut ? share(gate_end_) : 1.0);
}

void ArrivalTable::fill_cells() {
  const double events_per_cell = total_ / kCells;
  std::uint32_t cell = 0;
  std::size_t first_knot = 0;  // the last one before the cell's begin
  double begin = gate_begin_;
  for (std::size_t i = 0; i + 1 < knots_.size() && cell < kCells; ++i) {
    const Knot& left = knots_[i];
    const Knot& right = knots_[i + 1];
    const bool last = i + 2 == knots_.size();
    const double rise = right.cumulative - left.cumulative;
    const double slope = rise > 0.0 ? (right.time - left.time) / rise : 0.0;
    double end_cumulative = (cell + 1) * events_per_cell;
    while (cell < kCells && (end_cumulative <= right.cumulative || last)) {
      const double end = std::min(left.time + (end_cumulative - left.cumulative) * slope, right.time);
      cells_[cell] =
          i > first_knot + 1 ? Cell{static_cast<double>(first_knot), kSearch} : Cell{begin, end - begin};
      first_knot = i;
      begin = end;
      ++cell;
      end_cumulative = (cell + 1) * events_per_cell;
    }
  }
}

double ArrivalTable::search(double cumulative, std::size_t first_knot) const {
  std::size_t i = first_knot;
  while (i + 2 < knots_.size() && cumulative >= knots_[i + 1].cumulative) {
    ++i;
  }
  const double rise = knots_[i + 1].cumulative - knots_[i].cumulative;
  const double part = rise > 0.0 ? std::min((cumulative - knots_[i].cumulative) / rise, 1.0) : 0.0;
  return knots_[i].time + part * (knots_[i + 1].time - knots_[i].time);
}

double ArrivalTable::cumulative(double time) const {
  if (time <= gate_begin_) {
    return 0.0;
  }
  if (time >= gate_end_) {
    return total_;
  }
  const auto right = std::upper_bound(knots_.begin(), knots_.end(), time,
                                      [](double t, const Knot& knot) { return t < knot.time; });
  const Knot& left = *(right - 1);
  return left.cumulative +
         (right->cumulative - left.cumulative) * (time - left.time) / (right->time - left.time);
}

double ArrivalTable::displacement() const {
  if (total_ == 0.0 || pulse_events_ == 0.0) {
    return 0.0;
  }
  const auto exact = [&](double time) {
    return rates_.background * (time - gate_begin_) / code_count_ +
           pulse_events_ * (normal_share((time - rates_.centre_bins) / sigma_) -
                            normal_share((gate_begin_ - rates_.centre_bins) / sigma_));
  };
  // Area between both curves, walked along the table; a quarter of a cell is finer than what it leaves out.
  constexpr std::uint32_t kPoints = 4 * kCells;
  double area = 0.0;
  double time = gate_begin_;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const double middle = (i + 0.5) * total_ / kPoints;
    const double next = inverse((i + 1.0) * total_ / kPoints);
    area += (next - time) * std::abs(exact(inverse(middle)) - middle);
    time = next;
  }
  return area / total_;
}

}  // namespace dtof
