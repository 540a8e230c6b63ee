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
void HistogramCube::fail(const std::string& reason) const {
  throw InputError(fmt::format("{}: {}", name, reason));
}

void HistogramCube::validate() const {
  validate_axes();
  const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  if (counts.size() != pixels * static_cast<std::size_t>(bins)) {
    fail(fmt::format("{} counts for {} x {} pixels of {} bins", counts.size(), columns, rows, bins));
  }
  if (!true_distance.empty() && true_distance.size() != pixels) {
    fail(fmt::format("{} true distances for {} pixels", true_distance.size(), pixels));
  }
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      validate_counts(column, row, pixel(column, row));
    }
  }
}

void HistogramCube::validate_axes() const {
  if (columns < 1 || rows < 1 || bins < 1) {
    fail(fmt::format("{} x {} pixels of {} bins: each must be 1 or more", columns, rows, bins));
  }
  if (!std::isfinite(bin_width) || bin_width <= 0.0) {
    fail(fmt::format("bin width is {}, must be a positive number of seconds", bin_width));
  }
  if (!std::isfinite(offset)) {
    fail(fmt::format("offset is {}, must be a finite number of seconds", offset));
  }
}

void HistogramCube::validate_counts(int column, int row, std::span<const double> pixel_counts) const {
  constexpr double kLargestCount = 0x1.0p53;
  const auto illegal = std::ranges::find_if(
      pixel_counts, [](double count) { return !(count >= 0.0 && count <= kLargestCount); });
  if (illegal != pixel_counts.end()) {
    fail(fmt::format("column {}, row {}, bin {}: count {} is not in 0..2^53", column, row,
                     illegal - pixel_counts.begin(), *illegal));
  }
}

CountCheck::CountCheck(const HistogramCube& cube, const Resampling& resampling)
    : cube_(cube), budget_(resampling.photon_budget.has_value()) {}

void CountCheck::add(int column, int row, std::span<const double> counts) {
  cube_.validate_counts(column, row, counts);
  if (budget_) {
    return;
  }
  // Without a budget every count becomes a photon in memory.
  const double photons = std::accumulate(counts.begin(), counts.end(), 0.0);
  if (photons > kLargestPhotonNumber && too_many_.empty()) {
    too_many_ = fmt::format(
        "column {}, row {}: {:.0f} photons are more than the {:g} that a pixel can have in a frame; give a "
        "photon budget (--photons)",
        column, row, photons, kLargestPhotonNumber);
  }
  const auto fraction = std::ranges::find_if(counts, [](double count) { return count != std::floor(count); });
  if (fraction != counts.end() && fraction_.empty()) {
    fraction_ =
        fmt::format("column {}, row {}, bin {}: count {} is not an integer; give a photon budget (--photons)",
                    column, row, fraction - counts.begin(), *fraction);
  }
}

void CountCheck::finish() const {
  for (const std::string* const reason : {&too_many_, &fraction_}) {
    if (!reason->empty()) {
      cube_.fail(*reason);
    }
  }
}

HistogramStream::HistogramStream(HistogramCube cube, const Resampling& resampling)
    : HistogramStream(std::move(cube), resampling, Unchecked{}) {
  cube_.validate();
  CountCheck check(cube_, resampling);
  for (int row = 0; row < cube_.rows; ++row) {
    for (int column = 0; column < cube_.columns; ++column) {
      check.add(column, row, cube_.pixel(column, row));
    }
  }
  check.finish();
}

HistogramStream::HistogramStream(HistogramCube cube, const Resampling& resampling, Unchecked /*unchecked*/)
    : ResampledStream(cube.columns, cube.rows, resampling), cube_(std::move(cube)) {}

std::span<const double> HistogramStream::counts(int column, int row, std::vector<double>& /*room*/) const {
  return cube_.pixel(column, row);
}

void HistogramStream::draw_times(int column, int row, CounterRandom& random,
                                 std::vector<double>& times) const {
  std::vector<double> room;
  const std::span<const double> counts = this->counts(column, row, room);
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

HistogramCube cube_of_shape(std::span<const std::size_t> shape, double bin_width, double offset,
                            const std::string& name) {
  HistogramCube cube;
  cube.name = name;
  if (shape.empty()) {
    cube.fail("the array is a single number, its last axis must be the bins");
  }
  constexpr std::size_t kLargest = std::numeric_limits<int>::max();
  const std::size_t bins = shape.back();
  const std::size_t columns = shape.size() < 2 ? 1 : shape[shape.size() - 2];
  std::size_t rows = 1;
  for (std::size_t axis = 0; axis + 2 < shape.size(); ++axis) {
    rows *= shape[axis];
  }
  if (bins > kLargest || columns > kLargest || rows > kLargest) {
    cube.fail(fmt::format("{} x {} pixels of {} bins are too many", columns, rows, bins));
  }
  cube.columns = static_cast<int>(columns);
  cube.rows = static_cast<int>(rows);
  cube.bins = static_cast<int>(bins);
  cube.bin_width = bin_width;
  cube.offset = offset;
  cube.validate_axes();
  return cube;
}

HistogramCube histogram_cube(const NpyArray& array, double bin_width, double offset,
                             const std::string& name) {
  HistogramCube cube = cube_of_shape(array.shape, bin_width, offset, name);
  cube.counts = array.values;
  cube.validate();
  return cube;
}

}  // namespace dtof
