// SPDX-License-Identifier: Apache-2.0
#include "dtof/convert/histograms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

/// An empty cube of so many pixels.
HistogramCube empty_cube(const RecordingOptions& options, int columns, int rows, double bins,
                         double bin_width) {
  constexpr double kMostCounts = 0x1.0p27;
  if (!(bins >= 1.0 && bins * columns * rows <= kMostCounts)) {
    throw InputError(fmt::format("{}: {} x {} pixels of {:g} bins are none, or more than 2^27 bins",
                                 options.file, columns, rows, bins));
  }
  HistogramCube cube;
  cube.name = options.file;
  cube.columns = columns;
  cube.rows = rows;
  cube.bins = static_cast<int>(bins);
  cube.bin_width = bin_width;
  cube.counts.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                     static_cast<std::size_t>(cube.bins));
  return cube;
}

double& count_of(HistogramCube& cube, int column, int row, std::size_t bin) {
  const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(cube.columns) +
                     static_cast<std::size_t>(column);
  return cube.counts[pixel * static_cast<std::size_t>(cube.bins) + bin];
}

CountedHistograms of_stream(const RecordedStream& stream, const RecordingOptions& options) {
  const double codes = std::ldexp(1.0, options.resampling.np);
  CountedHistograms counted{.cube = empty_cube(options, stream.columns(), stream.rows(), codes,
                                               options.resampling.integration_time / codes)};
  for (int column = 0; column < stream.columns(); ++column) {
    const ColumnStream events = stream.column(column);
    for (int row = 0; row < events.rows(); ++row) {
      for (const Detection& detection : events.row(row)) {
        count_of(counted.cube, column, row, detection.timestamp) += 1.0;
      }
    }
  }
  return counted;
}

CountedHistograms of_times(const PhotonTimes& photons, const RecordingOptions& options) {
  const Resampling& range = options.resampling;
  const double width = options.bin_width_s.value_or(range.integration_time / std::ldexp(1.0, range.np));
  // A range that is a whole number of bins has that number, whatever the division rounds.
  const double bins = std::ceil(range.integration_time / width - 1e-9);
  CountedHistograms counted{.cube = empty_cube(options, photons.columns, photons.rows, bins, width)};
  for (int row = 0; row < photons.rows; ++row) {
    for (int column = 0; column < photons.columns; ++column) {
      for (const double tick : photons.pixel(column, row)) {
        const double bin = std::floor((tick * options.tick_s + range.time_shift) / width);
        if (bin >= 0.0 && bin < bins) {
          count_of(counted.cube, column, row, static_cast<std::size_t>(bin)) += 1.0;
        } else {
          ++counted.outside;
        }
      }
    }
  }
  (void)lost_photons_sentence(options.file, {.all = photons.ticks.size(), .outside = counted.outside},
                              range.integration_time);  // if all are lost
  return counted;
}

}  // namespace

CountedHistograms count_histograms(RecordedData measurement, const RecordingOptions& options) {
  options.resampling.validate();
  if (auto* const cube = std::get_if<HistogramCube>(&measurement.data)) {
    return {.cube = std::move(*cube)};
  }
  if (auto* const file = std::get_if<HistogramFile>(&measurement.data)) {
    return {.cube = held_cube(std::move(*file))};
  }
  if (const auto* const photons = std::get_if<PhotonTimes>(&measurement.data)) {
    return of_times(*photons, options);
  }
  return of_stream(std::get<RecordedStream>(measurement.data), options);
}

}  // namespace dtof
