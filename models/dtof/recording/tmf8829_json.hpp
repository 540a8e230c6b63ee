// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/recording/histogram_stream.hpp"

namespace dtof {

/// Bins of a histogram: 256 in the sensor's 8 x 8 modes, 64 in all others and in references.
inline constexpr std::size_t kTmf8829Bins = 64;
inline constexpr std::size_t kTmf8829FineBins = 256;
/// Bin width in s of a histogram with 64 bins. 122.2 mm per bin is the slope of histogram peaks against
/// on-chip distances in the published log. Its configuration has `bin_shift` 2 and `histogram_bins` 218, and
/// its histograms end in the middle of bin 54, at 218 / 2^2. So a bin is 2^bin_shift steps of a quarter of
/// this width.
inline constexpr double kTmf8829BinWidth = 815e-12;
inline constexpr std::int64_t kTmf8829BinShift = 2;
/// Centre of gravity of a histogram peak at distance zero, in bins (bin k counts as k), from the same fit.
inline constexpr double kTmf8829ZeroDistanceBin = 3.11;

/// A target that the sensor reported. Any member may be missing in a log, as in the manufacturer's own
/// viewer.
struct Tmf8829Peak {
  std::optional<double> distance;  ///< m, along the pixel's ray
  std::optional<double> x;         ///< m
  std::optional<double> y;         ///< m
  std::optional<double> z;         ///< m
  std::optional<std::int64_t> signal;
  std::optional<std::int64_t> snr;
};

struct Tmf8829Pixel {
  std::vector<Tmf8829Peak> peaks;
  std::optional<std::int64_t> noise;
  std::optional<std::int64_t> crosstalk;
};

/// One frame of an ams TMF8829 log (ams-OSRAM tmf8829_json_logfile_viewer).
///
/// `mp_histo` of the published log has 16 lists, each of which repeats one histogram 16 times. List i holds
/// the histogram of the pixel in row 0, column i: in all 26 frames its peaks agree with that pixel's reported
/// distance within 27 mm, and with no other row or column. Histograms of rows 1 to 15 are missing.
struct Tmf8829Frame {
  std::optional<std::int64_t> number;
  int rows = 0;
  int columns = 0;
  std::size_t bins = kTmf8829Bins;
  std::vector<Tmf8829Pixel> results;      ///< [row][column]
  std::vector<std::uint32_t> histograms;  ///< [list][entry][bin] as in the file, rows * columns * bins
  std::vector<std::vector<std::uint32_t>> reference;  ///< 64 bins each; may be empty

  [[nodiscard]] const Tmf8829Pixel& result(int row, int column) const {
    return results.at(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                      static_cast<std::size_t>(column));
  }
  [[nodiscard]] std::span<const std::uint32_t> histogram(int list, int entry) const {
    const auto index =
        static_cast<std::size_t>(list) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(entry);
    return std::span(histograms).subspan(index * bins, bins);
  }
  /// True if every list repeats one histogram, so that only row 0 is known.
  [[nodiscard]] bool only_row_zero() const;
};

struct Tmf8829Log {
  std::vector<Tmf8829Frame> frames;
  std::size_t left_out = 0;  ///< number of frames without results or without histograms, which are skipped
  double bin_width = kTmf8829BinWidth;  ///< s
};

/// Reads a log, plain or gzip. Throws InputError that names file and member.
Tmf8829Log read_tmf8829_json(const std::filesystem::path& path);

/// Parses text that was read from `path`, as read_tmf8829_json does.
Tmf8829Log parse_tmf8829_json(const std::filesystem::path& path, std::string_view text);

/// Cube of a log's histograms, with the first reported distance of each pixel as `true_distance` (NaN if
/// none). All frames must have the same size. If only row 0 is known, each frame is a column and each pixel
/// of row 0 a row. Otherwise the frames' columns are side by side, with their own rows. `name`: the file, for
/// error messages.
HistogramCube tmf8829_cube(const Tmf8829Log& log, double offset = 0.0,
                           const std::string& name = HistogramCube().name);

}  // namespace dtof
