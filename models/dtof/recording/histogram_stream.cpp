// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/histogram_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

/// Without a budget every count becomes a photon in memory.
void check_photon_numbers(const HistogramCube& cube) {
  for (int row = 0; row < cube.rows; ++row) {
    for (int column = 0; column < cube.columns; ++column) {
      const std::span<const double> counts = cube.pixel(column, row);
      const double photons = std::accumulate(counts.begin(), counts.end(), 0.0);
      if (photons > kLargestPhotonNumber) {
        cube.fail(
            fmt::format("column {}, row {}: {:.0f} photons are more than the {:g} that a pixel can "
                        "have in a frame; give a photon budget (--photons)",
                        column, row, photons, kLargestPhotonNumber));
      }
    }
  }
}

}  // namespace

void HistogramCube::fail(const std::string& reason) const {
  throw InputError(fmt::format("{}: {}", name, reason));
}

std::string HistogramCube::place(std::size_t index) const {
  const auto pixel = index / static_cast<std::size_t>(bins);
  return fmt::format("column {}, row {}, bin {}", pixel % static_cast<std::size_t>(columns),
                     pixel / static_cast<std::size_t>(columns), index % static_cast<std::size_t>(bins));
}

void HistogramCube::validate() const {
  if (columns < 1 || rows < 1 || bins < 1) {
    fail(fmt::format("{} x {} pixels of {} bins: each must be 1 or more", columns, rows, bins));
  }
  if (!std::isfinite(bin_width) || bin_width <= 0.0) {
    fail(fmt::format("bin width is {}, must be a positive number of seconds", bin_width));
  }
  if (!std::isfinite(offset)) {
    fail(fmt::format("offset is {}, must be a finite number of seconds", offset));
  }
  const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  if (counts.size() != pixels * static_cast<std::size_t>(bins)) {
    fail(fmt::format("{} counts for {} x {} pixels of {} bins", counts.size(), columns, rows, bins));
  }
  if (!true_distance.empty() && true_distance.size() != pixels) {
    fail(fmt::format("{} true distances for {} pixels", true_distance.size(), pixels));
  }
  constexpr double kLargestCount = 0x1.0p53;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!(counts[i] >= 0.0 && counts[i] <= kLargestCount)) {
      fail(fmt::format("{}: count {} is not in 0..2^53", place(i), counts[i]));
    }
  }
}

HistogramStream::HistogramStream(HistogramCube cube, const Resampling& resampling)
    : ResampledStream(cube.columns, cube.rows, resampling), cube_(std::move(cube)) {
  cube_.validate();
  if (!resampling.photon_budget) {
    check_photon_numbers(cube_);
    const auto fraction = std::find_if(cube_.counts.begin(), cube_.counts.end(),
                                       [](double count) { return count != std::floor(count); });
    if (fraction != cube_.counts.end()) {
      cube_.fail(fmt::format("{}: count {} is not an integer; give a photon budget (--photons)",
                             cube_.place(static_cast<std::size_t>(fraction - cube_.counts.begin())),
                             *fraction));
    }
  }
}

void HistogramStream::draw_times(int column, int row, CounterRandom& random,
                                 std::vector<double>& times) const {
  const std::span<const double> counts = cube_.pixel(column, row);
  const auto time_in_bin = [&](std::size_t bin) {
    return cube_.offset + (static_cast<double>(bin) + random.uniform()) * cube_.bin_width;
  };
  if (!resampling().photon_budget) {
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
      for (auto left = static_cast<std::uint64_t>(counts[bin]); left > 0; --left) {
        times.push_back(time_in_bin(bin));
      }
    }
    return;
  }
  std::vector<double> cumulative(counts.size());
  std::partial_sum(counts.begin(), counts.end(), cumulative.begin());
  const double sum = cumulative.back();
  if (sum <= 0.0) {
    return;
  }
  const std::uint64_t photons = draw_photon_number(*resampling().photon_budget, random);
  times.reserve(photons);
  for (std::uint64_t i = 0; i < photons; ++i) {
    // upper_bound cannot land in an empty bin; the product may round up to the sum itself.
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), random.uniform() * sum);
    const auto bin = found == cumulative.end()
                         ? std::lower_bound(cumulative.begin(), cumulative.end(), sum) - cumulative.begin()
                         : found - cumulative.begin();
    times.push_back(time_in_bin(static_cast<std::size_t>(bin)));
  }
}

HistogramCube histogram_cube(const NpyArray& array, double bin_width, double offset,
                             const std::string& name) {
  HistogramCube cube;
  cube.name = name;
  if (array.shape.empty()) {
    cube.fail("the array is a single number, its last axis must be the bins");
  }
  constexpr std::size_t kLargest = std::numeric_limits<int>::max();
  const std::size_t bins = array.shape.back();
  const std::size_t columns = array.shape.size() < 2 ? 1 : array.shape[array.shape.size() - 2];
  std::size_t rows = 1;
  for (std::size_t axis = 0; axis + 2 < array.shape.size(); ++axis) {
    rows *= array.shape[axis];
  }
  if (bins > kLargest || columns > kLargest || rows > kLargest) {
    cube.fail(fmt::format("{} x {} pixels of {} bins are too many", columns, rows, bins));
  }
  cube.columns = static_cast<int>(columns);
  cube.rows = static_cast<int>(rows);
  cube.bins = static_cast<int>(bins);
  cube.bin_width = bin_width;
  cube.offset = offset;
  cube.counts = array.values;
  cube.validate();
  return cube;
}

}  // namespace dtof
