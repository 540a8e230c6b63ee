// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/histogram_file.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

namespace dtof {

HistogramFile histogram_file(std::shared_ptr<ArrayReader> counts, double bin_width, double offset,
                             const std::string& name) {
  HistogramCube cube = cube_of_shape(counts->shape(), bin_width, offset, name);
  if (static_cast<std::size_t>(cube.bins) > kMostHeldElements) {
    cube.fail(fmt::format("a histogram of {} bins is longer than 2^27", cube.bins));
  }
  return {.cube = std::move(cube), .counts = std::move(counts)};
}

HistogramCube held_cube(HistogramFile file) {
  file.cube.counts = read_whole(file.cube.name, *file.counts).values;
  file.cube.validate();
  return std::move(file.cube);
}

HistogramFileStream::HistogramFileStream(HistogramFile file, const Resampling& resampling)
    : HistogramStream(std::move(file.cube), resampling, Unchecked{}), counts_(file.counts) {
  CountCheck check(cube(), resampling);
  std::vector<double> counts(static_cast<std::size_t>(cube().bins));
  for (int row = 0; row < cube().rows; ++row) {
    for (int column = 0; column < cube().columns; ++column) {
      file.counts->next(counts);
      check.add(column, row, counts);
    }
  }
  check.finish();
}

std::span<const double> HistogramFileStream::counts(int column, int row, std::vector<double>& room) const {
  const auto bins = static_cast<std::size_t>(cube().bins);
  const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(cube().columns) +
                            static_cast<std::size_t>(column);
  room.resize(bins);
  counts_->read_at(pixel * bins, room);
  return room;
}

}  // namespace dtof
