// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace dtof {

/// Light that returns to one pixel after a pulse: events in neighbouring bins of equal width. A view into a
/// TransientCube.
struct TransientLight {
  std::span<const double> cumulative;  ///< mean events up to each bin's end; empty: no light
  double begin = 0.0;                  ///< left edge of the first bin
  double bin_width = 0.0;

  [[nodiscard]] bool none() const { return cumulative.empty(); }
  /// Mean events of a pulse.
  [[nodiscard]] double events() const { return none() ? 0.0 : cumulative.back(); }
  /// Mean events before `time`.
  [[nodiscard]] double events_before(double time) const;
  /// Time before which `share` (0 .. below 1) of the events lie. Requires light.
  [[nodiscard]] double quantile(double share) const {
    if (cumulative.size() == 1) {
      return begin + bin_width * share;
    }
    const double events = share * cumulative.back();
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), events);
    const std::size_t bin =
        std::min(static_cast<std::size_t>(found - cumulative.begin()), cumulative.size() - 1);
    const double before = bin == 0 ? 0.0 : cumulative[bin - 1];
    return begin + bin_width * (static_cast<double>(bin) + (events - before) / (cumulative[bin] - before));
  }
};

/// Scale of a transient cube's numbers.
struct TransientScale {
  double bin_width_s = 0.0;      ///< > 0
  double start_s = 0.0;          ///< left edge of the first bin; 0: the moment of the laser's shot
  double events_per_unit = 1.0;  ///< detected events of a pixel and pulse for a value of 1; > 0
};

/// One return of a pixel, by its light alone, before the sensor's pulse widens it.
struct TransientReturn {
  double distance_m = 0.0;  ///< of the centroid; 0: no return
  double events = 0.0;
};

/// Light of a scene over time (a transient image): the mean detected events of each pixel and pulse in each
/// time bin, before the sensor's pulse and jitter widen them. Times count from the laser's shot. Within a
/// bin the light is uniform.
class TransientCube {
 public:
  /// No light yet. Throws InputError unless columns and rows are at least 1 and the scale is legal.
  TransientCube(int columns, int rows, const TransientScale& scale);

  [[nodiscard]] int columns() const { return columns_; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const TransientScale& scale() const { return scale_; }

  /// Sets a pixel's light, one value per bin. Throws InputError for a value that is negative or not finite.
  void set(int column, int row, std::span<const double> values);
  /// Light of a pixel; times in s.
  [[nodiscard]] TransientLight light(int column, int row) const;

  /// The strongest return of a pixel: the window of this length that holds the most events, the earliest of
  /// several. Bins count from their centres.
  [[nodiscard]] TransientReturn strongest_return(int column, int row, double window_s) const;
  /// The first return: the earliest window that holds at least a quarter of the strongest return's events,
  /// moved later by less than its length to where it holds the most.
  [[nodiscard]] TransientReturn first_return(int column, int row, double window_s) const;

 private:
  struct Pixel {
    std::size_t first_bin = 0;
    std::vector<double> cumulative;
  };

  [[nodiscard]] const Pixel& pixel(int column, int row) const {
    return pixels_[static_cast<std::size_t>(column) * static_cast<std::size_t>(rows_) +
                   static_cast<std::size_t>(row)];
  }
  [[nodiscard]] TransientReturn window_return(const Pixel& pixel, std::size_t begin,
                                              std::size_t length) const;
  [[nodiscard]] std::size_t window_bins(double window_s) const;

  int columns_;
  int rows_;
  TransientScale scale_;
  std::vector<Pixel> pixels_;  // column by column
};

}  // namespace dtof
