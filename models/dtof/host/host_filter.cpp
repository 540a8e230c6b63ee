// SPDX-License-Identifier: Apache-2.0
#include "dtof/host/host_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof_filter.h"

namespace dtof {
namespace {

constexpr double kUnitM = 1e-4;  // of the driver's depths

std::uint32_t to_units(double metres) {
  const double units = std::round(std::max(metres, 0.0) / kUnitM);
  return units <= double{DTOF_FILTER_MOST_DEPTH} ? static_cast<std::uint32_t>(units) : DTOF_FILTER_INVALID;
}

}  // namespace

void filter_depth(std::span<double> metres, int columns, double pulse_m) {
  constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max();
  const auto width = static_cast<std::size_t>(std::max(columns, 0));
  if (width == 0 || width > kMost || metres.empty() || metres.size() % width != 0 ||
      metres.size() / width > kMost) {
    throw InputError(fmt::format("host filter: {} pixels are no map of {} columns", metres.size(), columns));
  }
  const std::uint32_t pulse = std::isnan(pulse_m) ? 0 : to_units(pulse_m);
  if (pulse == 0 || pulse == DTOF_FILTER_INVALID) {
    throw InputError(fmt::format("host filter: a pulse of {} m", pulse_m));
  }
  std::vector<std::uint32_t> depths;
  for (const double distance : metres) {
    depths.push_back(std::isnan(distance) ? DTOF_FILTER_INVALID : to_units(distance));
  }
  std::vector<std::uint32_t> lines(DTOF_FILTER_LINES * width);
  const dtof_filter_settings settings = dtof_filter_defaults(pulse);
  dtof_filter(&settings, static_cast<std::uint16_t>(width), static_cast<std::uint16_t>(metres.size() / width),
              depths.data(), lines.data());
  std::ranges::transform(depths, metres.begin(), [](std::uint32_t depth) {
    return depth == DTOF_FILTER_INVALID ? std::numeric_limits<double>::quiet_NaN() : depth * kUnitM;
  });
}

double pulse_distance_m(double fwhm_s) { return 0.5 * kSpeedOfLight * fwhm_s; }

}  // namespace dtof
