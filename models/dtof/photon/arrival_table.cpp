// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/arrival_table.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "dtof/core/log_gamma.hpp"

namespace dtof {
namespace {

constexpr double kReachSigmas = 6.0;
constexpr int kKnotsPerSigma = 4;
constexpr double kFlatKnots = 32.0;  // over the whole range
constexpr double kSteep = 1.5;       // ratio of densities in a cell that a parabola is too coarse for

/// Share of a standard normal distribution below z.
double normal_share(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_density(double z) {
  return std::numbers::inv_sqrtpi / std::numbers::sqrt2 * std::exp(-0.5 * z * z);
}

bool same(const PixelRates& a, const PixelRates& b) {
  return a.background == b.background && a.signal == b.signal && a.centre_bins == b.centre_bins;
}

/// 1 - exp(-x); cheap where the steps between knots are small.
double one_minus_exp(double x) {
  constexpr double kSmall = 0.1;  // the series' first dropped term is below 2e-9 of the result
  return x < kSmall ? x * (1.0 - x * (1.0 / 2 - x * (1.0 / 6 - x * (1.0 / 24 - x * (1.0 / 120 - x / 720)))))
                    : -std::expm1(-x);
}

struct Kept {
  double events;  // E[min(N, slots)]
  double all;     // P(N >= slots): the next event is not kept
};

/// `some` = P(N >= 1).
Kept kept_events(double mean, double some, int slots) {
  // Sum of P(N > k) for k below `slots`; each is the one before less P(N = k).
  double more = some;
  double exactly = 1.0 - some;
  double kept = more;
  for (int k = 1; k < slots; ++k) {
    exactly *= mean / k;
    more = std::max(more - exactly, 0.0);
    kept += more;
  }
  return {kept, more};
}

/// Cubic between two knots with these paces at its ends.
class Hermite {
 public:
  template <typename Knot>
  Hermite(const Knot& left, const Knot& right)
      : begin_(left.cumulative),
        time_(left.time),
        per_rise_(right.cumulative > left.cumulative ? 1.0 / (right.cumulative - left.cumulative) : 0.0),
        step_(right.time - left.time) {
    // At most three times the chord's slope keeps it monotone (Fritsch and Carlson 1980).
    const double rise = right.cumulative - left.cumulative;
    const auto end_slope = [&](double pace) {
      return rise > 0.0 ? std::min(pace * rise, 3.0 * step_) : step_;
    };
    first_ = end_slope(left.pace);
    const double last = end_slope(right.pace);
    square_ = 3.0 * step_ - 2.0 * first_ - last;
    cube_ = first_ + last - 2.0 * step_;
  }
  [[nodiscard]] double part(double cumulative) const {
    return std::clamp((cumulative - begin_) * per_rise_, 0.0, 1.0);
  }
  [[nodiscard]] double time(double part) const {
    return time_ + std::min(part * (first_ + part * (square_ + part * cube_)), step_);
  }
  /// About the part at which `time` is reached; anything if the cubic is flat on the way.
  [[nodiscard]] double newton(double time) const {
    const double wanted = time - time_;
    double part = std::clamp(wanted / step_, 0.0, 1.0);
    for (int i = 0; i < 6; ++i) {
      const double over = part * (first_ + part * (square_ + part * cube_)) - wanted;
      const double slope = first_ + part * (2.0 * square_ + 3.0 * part * cube_);
      if (!(slope > 0.0)) {
        break;
      }
      part = std::clamp(part - over / slope, 0.0, 1.0);
      if (std::abs(over) < 1e-14 * step_) {
        break;
      }
    }
    return part;
  }
  [[nodiscard]] double pace(double part) const {
    return per_rise_ * std::max(first_ + part * (2.0 * square_ + 3.0 * part * cube_), 0.0);
  }

 private:
  double begin_;
  double time_;
  double per_rise_;
  double step_;
  double first_;
  double square_;
  double cube_;
};

}  // namespace

double kept_events(double mean, int slots) { return kept_events(mean, -std::expm1(-mean), slots).events; }

double at_least(int k, double mean) {
  if (k <= 0) {
    return 1.0;
  }
  if (mean < k) {
    // The upper tail term by term: the complement would cancel.
    double term = std::exp(k * std::log(std::max(mean, std::numeric_limits<double>::min())) - mean -
                           log_gamma(k + 1.0));
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
      sigma_(model.pulse_sigma_s() / model.time_resolution_s()),
      cells_(kCells) {
  const int half = static_cast<int>(kReachSigmas) * kKnotsPerSigma;
  for (int i = -half; i <= half; ++i) {
    const double z = static_cast<double>(i) / kKnotsPerSigma;
    pulse_offsets_.push_back(z * sigma_);
    pulse_shares_.push_back(normal_share(z));
    pulse_densities_.push_back(normal_density(z) / sigma_);
  }
}

void ArrivalTable::add_knot(double time, double pulse_share, double pulse_density) {
  const double mean = rates_.background * (time - gate_begin_) / code_count_ +
                      pulse_events_ * std::max(pulse_share - share_at_begin_, 0.0);
  // Infinite where nothing comes; the cubic takes its chord there.
  const double density = rates_.background / code_count_ + pulse_events_ * pulse_density;
  if (slots_ == 0) {
    knots_.push_back({mean, time, 1.0 / density});
  } else {
    some_ += (1.0 - some_) * one_minus_exp(std::max(mean - events_, 0.0));
    const Kept kept = kept_events(mean, some_, slots_);
    knots_.push_back({kept.events, time, 1.0 / (density * (1.0 - kept.all))});
  }
  events_ = mean;
}

void ArrivalTable::add_flat_knots(double from, double to, double pulse_share) {
  const double step = code_count_ / kFlatKnots;
  for (double time = from; time < to; time += step) {
    add_knot(time, pulse_share, 0.0);
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
    add_knot(gate_end_, 0.0, 0.0);
    return;
  }
  const auto share = [&](double time) { return normal_share((time - rates.centre_bins) / sigma_); };
  const auto density = [&](double time) {
    return normal_density((time - rates.centre_bins) / sigma_) / sigma_;
  };
  if (pulse_begin < gate_begin_) {
    share_at_begin_ = share(gate_begin_);
    add_knot(gate_begin_, share_at_begin_, density(gate_begin_));
  } else {
    add_flat_knots(gate_begin_, pulse_begin, 0.0);
  }
  for (std::size_t i = 0; i < pulse_offsets_.size(); ++i) {
    const double time = rates.centre_bins + pulse_offsets_[i];
    if (time > gate_begin_ && time < gate_end_) {
      add_knot(time, pulse_shares_[i], pulse_densities_[i]);
    }
  }
  const bool cut = pulse_end > gate_end_;
  if (!cut) {
    add_flat_knots(pulse_end, gate_end_, 1.0);
  }
  add_knot(gate_end_, cut ? share(gate_end_) : 1.0, cut ? density(gate_end_) : 0.0);
}

void ArrivalTable::fill_cells() {
  const double events_per_cell = total_ / kCells;
  std::uint32_t cell = 0;
  std::size_t first_knot = 0;  // the last one before the cell's begin
  double begin = gate_begin_;
  double begin_pace = knots_.front().pace;
  for (std::size_t i = 0; i + 1 < knots_.size() && cell < kCells; ++i) {
    const Hermite cubic(knots_[i], knots_[i + 1]);
    const bool last = i + 2 == knots_.size();
    double end_cumulative = (cell + 1) * events_per_cell;
    while (cell < kCells && (end_cumulative <= knots_[i + 1].cumulative || last)) {
      const double part = cubic.part(end_cumulative);
      const double end = cubic.time(part);
      const double end_pace = cubic.pace(part);
      const bool steep = end_pace > kSteep * begin_pace || begin_pace > kSteep * end_pace;
      if (i > first_knot + 1 || steep) {
        cells_[cell] = {static_cast<double>(first_knot), kSearch, 0.0};
      } else {
        // Paces at both ends make the curve; more than the chord would turn back.
        const double chord = end - begin;
        const double curve = std::clamp(0.5 * (end_pace - begin_pace) * events_per_cell, -chord, chord);
        cells_[cell] = {begin, chord - curve, curve};
      }
      first_knot = i;
      begin = end;
      begin_pace = end_pace;
      ++cell;
      end_cumulative = (cell + 1) * events_per_cell;
    }
  }
}

void ArrivalTable::inverse_codes(std::span<const double> cumulative, std::span<Timestamp> codes) const {
  // Without a call in the loop: those to be searched are noted, and done thereafter.
  const Cell* const cells = cells_.data();
  const double cells_per_event = cells_per_event_;
  const double last_time = last_time_;
  constexpr std::size_t kMost = 64;
  std::array<std::uint8_t, kMost> searched{};
  for (std::size_t begin = 0; begin < cumulative.size(); begin += kMost) {
    const std::size_t count = std::min(kMost, cumulative.size() - begin);
    const double* const means = &cumulative[begin];
    Timestamp* const out = &codes[begin];
    std::size_t searches = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double position = means[i] * cells_per_event;
      const std::int32_t index = std::min(static_cast<std::int32_t>(position), std::int32_t{kCells - 1});
      const Cell& cell = cells[static_cast<std::uint32_t>(index)];
      const double part = position - index;
      const double time = cell.time + part * (cell.slope + part * cell.curve);
      out[i] = static_cast<Timestamp>(static_cast<std::int32_t>(time < last_time ? time : last_time));
      searched[searches] = static_cast<std::uint8_t>(i);
      searches += cell.slope > kSearch ? 0 : 1;
    }
    for (std::size_t k = 0; k < searches; ++k) {
      const std::size_t i = searched[k];
      out[i] = static_cast<Timestamp>(static_cast<std::int32_t>(inverse(means[i])));
    }
  }
}

double ArrivalTable::search(double cumulative, std::size_t first_knot) const {
  std::size_t i = first_knot;
  while (i + 2 < knots_.size() && cumulative >= knots_[i + 1].cumulative) {
    ++i;
  }
  const Hermite cubic(knots_[i], knots_[i + 1]);
  return cubic.time(cubic.part(cumulative));
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
  const Hermite cubic(*(right - 1), *right);
  const double before = (right - 1)->cumulative;
  const double rise = right->cumulative - before;
  // The cubic is monotone: its place is the last step of 2^-40 before which it has not reached `time`. Newton
  // finds it at once, or nearly; where the cubic is too flat for that, halving cannot miss.
  constexpr double kSteps = 0x1.0p40;
  const auto before_time = [&](double step) { return cubic.time(step / kSteps) < time; };
  const double step = std::clamp(std::floor(cubic.newton(time) * kSteps), 1.0, kSteps - 2.0);
  double low = 0.0;
  double high = kSteps;
  if (before_time(step - 1.0) && !before_time(step + 2.0)) {
    low = step - 1.0;
    high = step + 2.0;
  }
  while (high - low > 1.0) {
    const double middle = std::floor(0.5 * (low + high));
    (before_time(middle) ? low : high) = middle;
  }
  return before + rise * (0.5 * (low + high) / kSteps);
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
