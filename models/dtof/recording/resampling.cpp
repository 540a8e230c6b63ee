// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/resampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

void check(bool legal, const char* what, double value, const char* range) {
  if (!legal) {
    throw InputError(fmt::format("resampling: {} is {}, must be {}", what, value, range));
  }
}

/// Number of events of a process of rate 1 up to `mean`, by exponential gaps: the same with every C++
/// library, which std::poisson_distribution is not.
std::uint64_t poisson(double mean, CounterRandom& random) {
  std::uint64_t events = 0;
  if (mean > 0.0) {
    for (double left = mean + std::log1p(-random.uniform()); left > 0.0;
         left += std::log1p(-random.uniform())) {
      ++events;
    }
  }
  return events;
}

/// A time in 2^-32 of T_int; nothing outside of it.
std::optional<std::uint64_t> time_step(double time, const Resampling& resampling) {
  constexpr double kTimeSteps = 0x1.0p32;
  const double step = std::floor(time / resampling.integration_time * kTimeSteps);
  return step >= 0.0 && step < kTimeSteps ? std::optional(static_cast<std::uint64_t>(step)) : std::nullopt;
}

}  // namespace

void Resampling::validate() const {
  check(np >= 1 && np <= 16, "NP", np, "1..16");
  check(std::isfinite(integration_time) && integration_time > 0.0, "integration time", integration_time,
        "a positive number of seconds");
  check(std::isfinite(time_shift), "time shift", time_shift, "a finite number of seconds");
  check(slots >= 1, "SLOTS", slots, "1 or more");
  const double budget = photon_budget.value_or(0.0);
  check(budget >= 0.0 && budget <= kLargestPhotonNumber, "photon budget", budget, "0..1e7 photons per pixel");
  check(background >= 0.0 && background * acquisitions <= kLargestPhotonNumber, "background", background,
        "0 or more events per acquisition, at most 1e7 per frame");
}

std::string lost_photons_sentence(const std::string& file, const PhotonCount& photons,
                                  double integration_time) {
  const std::string range = fmt::format("0 to {:g} ns", integration_time * 1e9);
  if (photons.all > 0 && photons.outside == photons.all) {
    throw InputError(fmt::format(
        "{}: all {} photons of the pixels read are outside the range, {}: --t-int and --shift move it", file,
        photons.all, range));
  }
  return photons.outside == 0 ? ""
                              : fmt::format("{} of {} photons are outside the range, {}, and lost",
                                            photons.outside, photons.all, range);
}

ResampledStream::ResampledStream(int columns, int rows, const Resampling& resampling)
    : columns_(columns), rows_(rows), resampling_(resampling) {
  resampling_.validate();
}

CounterRandom ResampledStream::random(int column, int row) const {
  const auto pixel = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns_) +
                     static_cast<std::uint32_t>(column);
  return {resampling_.seed, static_cast<std::uint32_t>(RandomPurpose::kResampling), resampling_.frame, pixel};
}

PhotonCount ResampledStream::count_photons(std::span<const int> columns, RowRange rows) const {
  PhotonCount count;
  std::vector<double> times;
  for (const int column : columns) {
    for (int row = rows.first; row < rows.first + rows.count; ++row) {
      CounterRandom numbers = random(column, row);
      times.clear();
      draw_times(column, row, numbers, times);
      count.all += times.size();
      count.outside += static_cast<std::uint64_t>(std::ranges::count_if(
          times, [&](double time) { return !time_step(time + resampling_.time_shift, resampling_); }));
    }
  }
  return count;
}

ColumnStream ResampledStream::column_rows(int index, RowRange range) const {
  ColumnStream stream;
  std::vector<double> times;
  for (int row = range.first; row < range.first + range.count; ++row) {
    CounterRandom numbers = random(index, row);
    times.clear();
    draw_times(index, row, numbers, times);
    for (double& time : times) {
      time += resampling_.time_shift;
    }
    const std::uint64_t background = poisson(resampling_.background * resampling_.acquisitions, numbers);
    for (std::uint64_t i = 0; i < background; ++i) {
      times.push_back(numbers.uniform() * resampling_.integration_time);
    }
    stream.append_row(assign_to_acquisitions(times, resampling_, numbers));
  }
  return stream;
}

std::uint64_t ResampledStream::draw_photon_number(double budget, CounterRandom& random) const {
  return resampling_.photon_number == PhotonNumber::kFixed ? static_cast<std::uint64_t>(std::llround(budget))
                                                           : poisson(budget, random);
}

std::vector<Detection> assign_to_acquisitions(std::span<const double> times, const Resampling& resampling,
                                              CounterRandom& random) {
  std::vector<Detection> detections;
  if (resampling.acquisitions == 0) {
    return detections;
  }
  // One key sorts by acquisition, then by time in 2^-32 of T_int; its upper time bits are the timestamp.
  std::vector<std::uint64_t> keys;
  keys.reserve(times.size());
  for (const double time : times) {
    const std::uint64_t acquisition = (static_cast<std::uint64_t>(random()) * resampling.acquisitions) >> 32U;
    if (const std::optional<std::uint64_t> step = time_step(time, resampling)) {
      keys.push_back(acquisition << 32U | *step);
    }
  }
  std::sort(keys.begin(), keys.end());
  const auto slots = static_cast<std::size_t>(resampling.slots);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto acquisition = static_cast<std::uint32_t>(keys[i] >> 32U);
    if (i >= slots && keys[i - slots] >> 32U == acquisition) {
      continue;
    }
    const std::uint64_t step = keys[i] & 0xFFFF'FFFFU;
    detections.push_back(
        {acquisition, static_cast<Timestamp>(step >> static_cast<unsigned>(32 - resampling.np))});
  }
  return detections;
}

}  // namespace dtof
