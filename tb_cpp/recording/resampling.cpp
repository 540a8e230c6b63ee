// SPDX-License-Identifier: Apache-2.0
#include "recording/resampling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

#include "core/error.hpp"

namespace dtof {
namespace {

void check(bool legal, const char* what, double value, const char* range) {
  if (!legal) {
    throw InputError(fmt::format("resampling: {} is {}, must be {}", what, value, range));
  }
}

std::uint64_t poisson(double mean, CounterRandom& random) {
  return mean > 0.0 ? std::poisson_distribution<std::uint64_t>(mean)(random) : 0;
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

ResampledStream::ResampledStream(int columns, int rows, const Resampling& resampling)
    : columns_(columns), rows_(rows), resampling_(resampling) {
  resampling_.validate();
}

ColumnStream ResampledStream::column_rows(int index, RowRange range) const {
  ColumnStream stream;
  std::vector<double> times;
  for (int row = range.first; row < range.first + range.count; ++row) {
    const auto pixel = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(columns_) +
                       static_cast<std::uint32_t>(index);
    CounterRandom random(resampling_.seed, static_cast<std::uint32_t>(RandomPurpose::kResampling),
                         resampling_.frame, pixel);
    times.clear();
    draw_times(index, row, random, times);
    for (double& time : times) {
      time += resampling_.time_shift;
    }
    const std::uint64_t background = poisson(resampling_.background * resampling_.acquisitions, random);
    for (std::uint64_t i = 0; i < background; ++i) {
      times.push_back(random.uniform() * resampling_.integration_time);
    }
    stream.append_row(assign_to_acquisitions(times, resampling_, random));
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
  constexpr double kTimeSteps = 0x1.0p32;
  std::vector<std::uint64_t> keys;
  keys.reserve(times.size());
  for (const double time : times) {
    const std::uint64_t acquisition = (static_cast<std::uint64_t>(random()) * resampling.acquisitions) >> 32U;
    const double step = std::floor(time / resampling.integration_time * kTimeSteps);
    if (step >= 0.0 && step < kTimeSteps) {
      keys.push_back(acquisition << 32U | static_cast<std::uint64_t>(step));
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
