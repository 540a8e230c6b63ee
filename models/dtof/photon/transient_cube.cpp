// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/transient_cube.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"

namespace dtof {
namespace {

// A first return has at least this share of the strongest return's events: less is stray light.
constexpr double kFirstReturnShare = 0.25;

/// Events of `length` bins from `begin` on, as far as they exist.
double window_events(std::span<const double> cumulative, std::size_t begin, std::size_t length) {
  const std::size_t end = std::min(begin + length, cumulative.size());
  return cumulative[end - 1] - (begin == 0 ? 0.0 : cumulative[begin - 1]);
}

}  // namespace

double TransientLight::events_before(double time) const {
  const double position = (time - begin) / bin_width;
  if (none() || position <= 0.0) {
    return 0.0;
  }
  if (position >= static_cast<double>(cumulative.size())) {
    return cumulative.back();
  }
  const auto bin = static_cast<std::size_t>(position);
  const double before = bin == 0 ? 0.0 : cumulative[bin - 1];
  return before + (position - static_cast<double>(bin)) * (cumulative[bin] - before);
}

TransientCube::TransientCube(int columns, int rows, const TransientScale& scale)
    : columns_(columns), rows_(rows), scale_(scale) {
  if (columns < 1 || rows < 1) {
    throw InputError(
        fmt::format("a transient cube must have at least 1 x 1 pixels, not {} x {}", columns, rows));
  }
  // Written so that a NaN fails.
  if (!(scale.bin_width_s > 0.0) || !std::isfinite(scale.bin_width_s)) {
    throw InputError(
        fmt::format("a transient cube's bin width must be above 0 s, not {}", scale.bin_width_s));
  }
  if (!std::isfinite(scale.start_s)) {
    throw InputError(fmt::format("a transient cube's start must be a finite time, not {} s", scale.start_s));
  }
  if (!(scale.events_per_unit > 0.0) || !std::isfinite(scale.events_per_unit)) {
    throw InputError(
        fmt::format("a transient cube's scale must be above 0 events, not {}", scale.events_per_unit));
  }
  pixels_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
}

void TransientCube::set(int column, int row, std::span<const double> values) {
  Pixel light;
  std::size_t end = 0;
  for (std::size_t bin = 0; bin < values.size(); ++bin) {
    if (!(values[bin] >= 0.0) || !std::isfinite(values[bin] * scale_.events_per_unit)) {
      throw InputError(fmt::format("column {}, row {}, bin {}: {} is not a finite number of at least 0",
                                   column, row, bin, values[bin]));
    }
    if (values[bin] > 0.0) {
      if (end == 0) {
        light.first_bin = bin;
      }
      end = bin + 1;
    }
  }
  double sum = 0.0;
  for (std::size_t bin = light.first_bin; bin < end; ++bin) {
    sum += values[bin] * scale_.events_per_unit;
    light.cumulative.push_back(sum);
  }
  // A bin that is too small for the sum before it has no place in it.
  while (light.cumulative.size() > 1 &&
         light.cumulative.back() == light.cumulative[light.cumulative.size() - 2]) {
    light.cumulative.pop_back();
  }
  if (!(sum > 0.0)) {
    light = {};
  } else if (!std::isfinite(sum)) {
    throw InputError(fmt::format("column {}, row {}: the sum of the bins overflows", column, row));
  }
  pixels_[static_cast<std::size_t>(column) * static_cast<std::size_t>(rows_) +
          static_cast<std::size_t>(row)] = std::move(light);
}

TransientLight TransientCube::light(int column, int row) const {
  const Pixel& own = pixel(column, row);
  return {.cumulative = own.cumulative,
          .begin = scale_.start_s + static_cast<double>(own.first_bin) * scale_.bin_width_s,
          .bin_width = scale_.bin_width_s};
}

std::size_t TransientCube::window_bins(double window_s) const {
  return static_cast<std::size_t>(std::max(1.0, std::round(std::min(window_s / scale_.bin_width_s, 1e9))));
}

TransientReturn TransientCube::window_return(const Pixel& pixel, std::size_t begin,
                                             std::size_t length) const {
  const std::size_t end = std::min(begin + length, pixel.cumulative.size());
  double events = 0.0;
  double moment = 0.0;
  for (std::size_t bin = begin; bin < end; ++bin) {
    const double own = pixel.cumulative[bin] - (bin == 0 ? 0.0 : pixel.cumulative[bin - 1]);
    events += own;
    moment += own * (static_cast<double>(bin) + 0.5);
  }
  const double time =
      scale_.start_s + (static_cast<double>(pixel.first_bin) + moment / events) * scale_.bin_width_s;
  return {.distance_m = 0.5 * kSpeedOfLight * time, .events = events};
}

TransientReturn TransientCube::strongest_return(int column, int row, double window_s) const {
  const Pixel& own = pixel(column, row);
  if (own.cumulative.empty()) {
    return {};
  }
  const std::size_t length = window_bins(window_s);
  std::size_t best = 0;
  for (std::size_t begin = 1; begin < own.cumulative.size(); ++begin) {
    // A window with more by rounding alone is no later one.
    if (window_events(own.cumulative, begin, length) >
        window_events(own.cumulative, best, length) * (1.0 + 1e-12)) {
      best = begin;
    }
  }
  return window_return(own, best, length);
}

TransientReturn TransientCube::first_return(int column, int row, double window_s) const {
  const Pixel& own = pixel(column, row);
  if (own.cumulative.empty()) {
    return {};
  }
  const std::size_t length = window_bins(window_s);
  const double least = kFirstReturnShare * strongest_return(column, row, window_s).events;
  std::size_t begin = 0;
  while (window_events(own.cumulative, begin, length) < least) {
    ++begin;
  }
  // On to where the window holds the most before it holds less again.
  std::size_t best = begin;
  for (std::size_t next = begin + 1; next < std::min(begin + length, own.cumulative.size()); ++next) {
    if (window_events(own.cumulative, next, length) >
        window_events(own.cumulative, best, length) * (1.0 + 1e-12)) {
      best = next;
    }
  }
  return window_return(own, best, length);
}

}  // namespace dtof
