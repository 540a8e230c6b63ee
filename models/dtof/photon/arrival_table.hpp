// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/photon/event_sampler.hpp"
#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// E[min(N, slots)] for a Poisson number N with this mean >= 0: the mean number of events that a TDC with
/// `slots` >= 1 keeps.
double kept_events(double mean, int slots);
/// P(N >= k) for a Poisson number N with this mean >= 0; k >= 0.
double at_least(int k, double mean);

/// Table of a pixel's cumulative mean events C(t) over one acquisition, and of its inverse. Events are a flat
/// background and a Gaussian pulse inside the time gate. The inverse maps points of a Poisson process with
/// rate 1 to the pixel's events in time order (time change of a Poisson process). Time is in units of T_res.
///
/// A TDC keeps the first `slots` events of an acquisition. The mean number of kept events before t is
/// kept_events(C(t), slots); a table on that scale gives times of kept events.
///
/// The inverse is a monotone cubic (Hermite) between knots. Knots lie every 1/4 sigma over the pulse, up to 6
/// sigma on both sides (the 2e-9 beyond are dropped), and every 32nd of the range elsewhere. For speed the
/// inverse is stored in 256 cells of equal C, quadratic in each. Only cells with several knots or a steep
/// density are searched, e.g. the tails of a pulse on little background.
class ArrivalTable {
 public:
  explicit ArrivalTable(const SensorModel& model);

  /// Builds the table of C(t). Does nothing if the table for `rates` is already built.
  void build(const PixelRates& rates) { build(rates, 0); }
  /// Builds the table of kept events. Does nothing if the table for `rates` and `slots` is already built.
  void build_kept(const PixelRates& rates, int slots) { build(rates, slots); }

  /// Mean events of an acquisition inside the gate, on the scale of the table (all events or kept events).
  [[nodiscard]] double total() const { return total_; }
  /// Mean events of an acquisition inside the gate, whatever the scale.
  [[nodiscard]] double events() const { return events_; }
  /// Time at which the mean number of events is `cumulative`, in [0, total()). Lies within [gate begin, gate
  /// end). Requires total() > 0.
  [[nodiscard]] double inverse(double cumulative) const {
    const double position = cumulative * cells_per_event_;
    const auto index = std::min(static_cast<std::uint32_t>(static_cast<std::int32_t>(position)), kCells - 1);
    const Cell& cell = cells_[index];
    const double part = position - index;
    const double time = cell.slope > kSearch ? cell.time + part * (cell.slope + part * cell.curve)
                                             : search(cumulative, static_cast<std::size_t>(cell.time));
    return std::min(time, last_time_);
  }
  /// Codes (inverse rounded down) of all values of `cumulative`; both spans have the same length.
  void inverse_codes(std::span<const double> cumulative, std::span<Timestamp> codes) const;
  /// Mean events before `time`, 0 .. total(), on the scale of the table.
  [[nodiscard]] double cumulative(double time) const;

  /// Mean absolute displacement of an event against the exact distribution, in bins (Wasserstein distance):
  /// the area between the table and the exact C(t), divided by C's total. For a table of C(t); 0 without a
  /// pulse in the gate.
  [[nodiscard]] double displacement() const;

 private:
  struct Knot {
    double cumulative;
    double time;
    double pace;  // d time / d cumulative
  };
  struct Cell {
    double time;   // at its begin; the knot to search from if slope is kSearch
    double slope;  // bins over the cell
    double curve;
  };
  static constexpr std::uint32_t kCells = 256;
  static constexpr double kSearch = -1.0;

  void build(const PixelRates& rates, int slots);
  void place_knots(const PixelRates& rates);
  void add_knot(double time, double pulse_share, double pulse_density);
  void add_flat_knots(double from, double to, double pulse_share);
  void fill_cells();
  [[nodiscard]] double search(double cumulative, std::size_t first_knot) const;

  double code_count_;
  double gate_begin_;
  double gate_end_;
  double last_time_;
  double sigma_;
  std::vector<double> pulse_offsets_;    // of the pulse's knots from its centre
  std::vector<double> pulse_shares_;     // of the pulse before each
  std::vector<double> pulse_densities_;  // of the pulse at each, per bin

  PixelRates rates_;
  int slots_ = -1;
  double pulse_events_ = 0.0;
  double share_at_begin_ = 0.0;
  double total_ = 0.0;
  double events_ = 0.0;
  double some_ = 0.0;  // P(N >= 1) at the last knot
  double cells_per_event_ = 0.0;
  std::vector<Knot> knots_;
  std::vector<Cell> cells_;
};

}  // namespace dtof
