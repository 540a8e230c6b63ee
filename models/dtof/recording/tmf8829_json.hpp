// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

inline constexpr std::size_t kTmf8829Bins = 64;
/// s; 122.2 mm per bin, the slope of histogram peaks against on-chip distances in the published log.
inline constexpr double kTmf8829BinWidth = 815e-12;
/// Centre of gravity of a histogram peak at distance zero, in bins (bin k counts as k), from the same fit.
inline constexpr double kTmf8829ZeroDistanceBin = 3.11;

/// A target that the sensor reported.
struct Tmf8829Peak {
  double distance = 0.0;  ///< m, along the pixel's ray
  double x = 0.0;         ///< m
  double y = 0.0;         ///< m
  double z = 0.0;         ///< m
  std::int64_t signal = 0;
  std::int64_t snr = 0;
};

struct Tmf8829Pixel {
  std::vector<Tmf8829Peak> peaks;
  std::int64_t noise = 0;
  std::int64_t crosstalk = 0;
};

/// One frame of an ams TMF8829 log (ams-OSRAM tmf8829_json_logfile_viewer).
///
/// `mp_histo` of the published log repeats one histogram 16 times in each of its 16 lists: list i holds the
/// histogram of the pixel in row 0, column i (its peaks follow that pixel's reported distance to 27 mm in all
/// 26 frames, and no other row's or column's). Histograms of rows 1 to 15 are not in it.
struct Tmf8829Frame {
  std::int64_t number = 0;
  int rows = 0;
  int columns = 0;
  std::vector<Tmf8829Pixel> results;      ///< [row][column]
  std::vector<std::uint32_t> histograms;  ///< [list][entry][bin] as in the file, rows * columns * 64
  std::vector<std::vector<std::uint32_t>> reference;  ///< 64 bins each

  [[nodiscard]] const Tmf8829Pixel& result(int row, int column) const {
    return results.at(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column));
  }
  [[nodiscard]] std::span<const std::uint32_t> histogram(int list, int entry) const {
    const auto index =
        static_cast<std::size_t>(list) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(entry);
    return std::span(histograms).subspan(index * kTmf8829Bins, kTmf8829Bins);
  }
  /// Every list repeats one histogram, so that only row 0 is known.
  [[nodiscard]] bool only_row_zero() const;
};

/// Reads a log, plain or gzip. Throws InputError naming file and member that is wrong.
std::vector<Tmf8829Frame> read_tmf8829_json(const std::filesystem::path& path);

/// Cube of the histograms that the log holds, with the first on-chip distance of each pixel as
/// `true_distance` (NaN where the sensor reported none). `frames` must agree in size. A log that knows row 0
/// only: one column a frame, one row a pixel of row 0. Otherwise: the frames' columns side by side, with
/// their own rows.
HistogramCube tmf8829_cube(std::span<const Tmf8829Frame> frames, double bin_width = kTmf8829BinWidth,
                           double offset = 0.0);

}  // namespace dtof
