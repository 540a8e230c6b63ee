// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "dtof/io/npy.hpp"
#include "dtof/recording/resampling.hpp"

namespace dtof {

/// Measured photon counts of an array of pixels.
struct HistogramCube {
  int columns = 0;
  int rows = 0;
  int bins = 0;
  double bin_width = 0.0;                  ///< s
  double offset = 0.0;                     ///< time of the left edge of bin 0, s
  std::vector<double> counts = {};         ///< [row][column][bin], rows * columns * bins numbers >= 0
  std::vector<double> true_distance = {};  ///< m, [row][column], NaN = unknown; empty: nothing is known
  std::string name = "histograms";         ///< name of the file, for error messages

  [[nodiscard]] std::span<const double> pixel(int column, int row) const {
    const auto index =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    return std::span(counts).subspan(index * static_cast<std::size_t>(bins), static_cast<std::size_t>(bins));
  }
  /// Throws InputError if sizes disagree, or a count is negative, not finite or above 2^53.
  void validate() const;
  /// Throws InputError if columns, rows, bins, bin width or offset are illegal.
  void validate_axes() const;
  /// Throws InputError if a count of this pixel is negative, not finite or above 2^53.
  void validate_counts(int column, int row, std::span<const double> pixel_counts) const;
  /// Throws InputError "<name>: <reason>".
  [[noreturn]] void fail(const std::string& reason) const;
};

/// Whether counts can become photons in memory, pixel by pixel. Without a photon budget a pixel has at most
/// kLargestPhotonNumber photons, and counts are integers.
class CountCheck {
 public:
  CountCheck(const HistogramCube& cube, const Resampling& resampling);

  /// Throws InputError for an illegal count.
  void add(int column, int row, std::span<const double> counts);
  /// Throws InputError for the first pixel with too many photons, else for the first fraction.
  void finish() const;

 private:
  const HistogramCube& cube_;
  bool budget_;
  std::string too_many_;
  std::string fraction_;
};

/// TDC stream of one frame from a histogram cube (recording/resampling.hpp). A photon's time is uniform
/// within its bin.
///
/// With a photon budget, photons are drawn with replacement from the pixel's normalised histogram, Poisson or
/// fixed in number, so many frames can be made from one capture. A pixel without counts has no photons.
/// Without a budget each count is one photon, and counts must be integers.
class HistogramStream : public ResampledStream {
 public:
  /// Throws InputError for an invalid cube or resampling.
  HistogramStream(HistogramCube cube, const Resampling& resampling);

  [[nodiscard]] const HistogramCube& cube() const { return cube_; }

 protected:
  struct Unchecked {};
  /// Without a check of the counts.
  HistogramStream(HistogramCube cube, const Resampling& resampling, Unchecked unchecked);

 private:
  void draw_times(int column, int row, CounterRandom& random, std::vector<double>& times) const override;
  /// Counts of a pixel, in the cube or in `room`.
  [[nodiscard]] virtual std::span<const double> counts(int column, int row, std::vector<double>& room) const;

  HistogramCube cube_;
};

/// A cube without counts, of the shape of an array: as histogram_cube.
HistogramCube cube_of_shape(std::span<const std::size_t> shape, double bin_width, double offset,
                            const std::string& name);

/// Makes a cube from an array whose last axis is the bins: [bins], [columns, bins] or [..., rows, columns,
/// bins] (leading axes are stacked as rows). Widths in s. Throws InputError for a scalar, or for counts that
/// HistogramCube::validate refuses.
HistogramCube histogram_cube(const NpyArray& array, double bin_width, double offset = 0.0,
                             const std::string& name = HistogramCube().name);

}  // namespace dtof
