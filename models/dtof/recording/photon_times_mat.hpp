// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/io/npy.hpp"
#include "dtof/recording/resampling.hpp"

namespace dtof {

/// Raw photon arrival times of an array of pixels, in ticks of the time-tagging hardware.
struct PhotonTimes {
  int columns = 0;
  int rows = 0;
  std::vector<double> ticks;       ///< all pixels, [row][column]
  std::vector<std::size_t> begin;  ///< rows * columns + 1 offsets into `ticks`

  [[nodiscard]] std::span<const double> pixel(int column, int row) const {
    const auto index =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    return std::span(ticks).subspan(begin[index], begin[index + 1] - begin[index]);
  }
};

/// A two-dimensional numeric variable of a MATLAB file, e.g. the true depth of a measurement.
struct MatMatrix {
  int columns = 0;
  int rows = 0;
  std::vector<double> values;  ///< [row][column]
};

/// Reads a two-dimensional cell array of numeric vectors (one cell a pixel, empty cells allowed) from a
/// MATLAB file. Throws InputError "<path>: <reason>" when file or variable is missing, damaged or of another
/// kind.
PhotonTimes read_photon_times_mat(const std::filesystem::path& path,
                                  const std::string& variable = "photon_times");

/// The same of contents that `path` has already given.
PhotonTimes parse_photon_times_mat(const std::filesystem::path& path, std::string_view file,
                                   const std::string& variable = "photon_times");

/// A real numeric variable of any number of axes, in C order, of contents that `path` has already given; at
/// most 2^27 elements. Throws InputError as above.
NpyArray parse_mat_array(const std::filesystem::path& path, std::string_view file,
                         const std::string& variable);

/// Reads a two-dimensional real numeric variable. Throws InputError as above.
MatMatrix read_mat_matrix(const std::filesystem::path& path, const std::string& variable);

/// Raw photon times as the stream of one frame (io/resampling.hpp): time = tick * tick_duration + time_shift.
///
/// With a photon budget below a pixel's photon number the photons are thinned: kPoisson keeps each with the
/// probability budget / number (binomial, as a weaker laser would), kFixed keeps exactly the budget. A pixel
/// that has fewer photons than the budget keeps them all.
class PhotonTimesStream : public ResampledStream {
 public:
  /// `tick_duration` in s. Throws InputError for an impossible value.
  PhotonTimesStream(PhotonTimes photons, double tick_duration, const Resampling& resampling);

  [[nodiscard]] const PhotonTimes& photons() const { return photons_; }

 private:
  void draw_times(int column, int row, CounterRandom& random, std::vector<double>& times) const override;

  PhotonTimes photons_;
  double tick_duration_;
};

}  // namespace dtof
