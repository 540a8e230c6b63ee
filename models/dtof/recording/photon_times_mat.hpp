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

/// Photon arrival times of an array of pixels, in ticks of the time tagger.
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

/// Reads a two-dimensional cell array of numeric vectors from a MATLAB file, one cell per pixel; cells may be
/// empty. Throws InputError "<path>: <reason>" if file or variable is missing, damaged or of another kind.
PhotonTimes read_photon_times_mat(const std::filesystem::path& path,
                                  const std::string& variable = "photon_times");

/// Parses contents that were read from `path`, as read_photon_times_mat does.
PhotonTimes parse_photon_times_mat(const std::filesystem::path& path, std::string_view file,
                                   const std::string& variable = "photon_times");

/// Parses a real numeric variable with any number of axes, in C order; at most 2^27 elements. `file` holds
/// the contents of `path`. Throws InputError as read_photon_times_mat does.
NpyArray parse_mat_array(const std::filesystem::path& path, std::string_view file,
                         const std::string& variable);

/// Reads a two-dimensional real numeric variable. Throws InputError as read_photon_times_mat does.
MatMatrix read_mat_matrix(const std::filesystem::path& path, const std::string& variable);

/// TDC stream of one frame from photon times (recording/resampling.hpp). Time = tick * tick_duration +
/// time_shift.
///
/// With a photon budget below a pixel's photon number, photons are thinned. kPoisson keeps each with
/// probability budget / number (binomial, as with a weaker laser); kFixed keeps exactly the budget. A pixel
/// with fewer photons than the budget keeps them all.
class PhotonTimesStream : public ResampledStream {
 public:
  /// `tick_duration` in s, > 0. Throws InputError for an illegal value.
  PhotonTimesStream(PhotonTimes photons, double tick_duration, const Resampling& resampling);

  [[nodiscard]] const PhotonTimes& photons() const { return photons_; }

 private:
  void draw_times(int column, int row, CounterRandom& random, std::vector<double>& times) const override;

  PhotonTimes photons_;
  double tick_duration_;
};

}  // namespace dtof
