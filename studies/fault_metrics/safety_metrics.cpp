// SPDX-License-Identifier: Apache-2.0
#include "fault_metrics/safety_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace dtof {
namespace {

constexpr double kQuantile = 1.959963984540054;  // of the normal distribution, for 95 %

/// Wilson's interval for a number of trials that need not be an integer.
Interval wilson(double share, double trials) {
  const double z2 = kQuantile * kQuantile;
  const double centre = share + z2 / (2.0 * trials);
  const double half = kQuantile * std::sqrt(share * (1.0 - share) / trials + z2 / (4.0 * trials * trials));
  const double scale = 1.0 + z2 / trials;
  return {std::clamp((centre - half) / scale, 0.0, share), std::clamp((centre + half) / scale, share, 1.0)};
}

std::uint64_t all(const FaultCounts& counts) { return counts.faults; }
std::uint64_t harmful(const FaultCounts& counts) { return counts.harmful; }

}  // namespace

const FaultCounts& counts_of(const StratumResult& stratum, FaultLife life) {
  return life == FaultLife::kEvent ? stratum.events : stratum.stuck;
}

double weighted_sum(std::span<const StratumResult> strata, FaultLife life, const Counted& part) {
  double sum = 0.0;
  for (const StratumResult& stratum : strata) {
    const FaultCounts& counts = counts_of(stratum, life);
    if (counts.faults > 0) {
      sum += stratum.full_sites * static_cast<double>(part(counts)) / static_cast<double>(counts.faults);
    }
  }
  return sum;
}

Estimate weighted_share(std::span<const StratumResult> strata, FaultLife life, const Counted& part,
                        const Counted& whole) {
  const double total = weighted_sum(strata, life, whole);
  if (total <= 0.0) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    return {.value = unknown, .interval = {unknown, unknown}};
  }
  // A value that rounding leaves beside 1 has no variance.
  const double share = std::min(weighted_sum(strata, life, part) / total, 1.0);
  double variance = 0.0;
  double squares = 0.0;
  for (const StratumResult& stratum : strata) {
    const FaultCounts& counts = counts_of(stratum, life);
    if (counts.faults == 0) {
      continue;
    }
    const auto drawn = static_cast<double>(counts.faults);
    const auto in = static_cast<double>(part(counts));
    const auto of = static_cast<double>(whole(counts));
    const double mean = (in - share * of) / drawn;
    const double square =
        (in * (1.0 - share) * (1.0 - share) + (of - in) * share * share) / drawn - mean * mean;
    const double weight = stratum.full_sites / total;
    variance += weight * weight * square / drawn;
    squares += weight * weight * of / (drawn * drawn);
  }
  const bool certain = share * (1.0 - share) < std::numeric_limits<double>::epsilon() * 16.0;
  const double trials = certain ? 1.0 / squares : share * (1.0 - share) / variance;
  return {.value = share, .interval = wilson(share, trials)};
}

SafetyMetrics safety_metrics(const ArrayResult& result, FaultLife life) {
  const auto share = [&](const Counted& part, const Counted& whole) {
    return weighted_share(result.strata, life, part, whole);
  };
  const auto found = [](const FaultCounts& counts) { return counts.harmful - counts.undetected; };
  std::vector<StratumResult> logic = result.strata;
  std::erase_if(logic, [](const StratumResult& stratum) { return stratum.element == Element::kBit; });
  const auto covered = [](const FaultCounts& counts) { return counts.faults - counts.undetected; };
  return {.harmful = share(harmful, all),
          .detected = share(found, harmful),
          .detected_beyond = share([](const FaultCounts& c) { return c.beyond - c.undetected_beyond; },
                                   [](const FaultCounts& c) { return c.beyond; }),
          .in_logic = weighted_share(logic, life, found, harmful),
          .in_frame = share(
              [](const FaultCounts& c) { return c.by_parity + c.by_protocol + c.by_frame_check; }, harmful),
          .single_point = share(covered, all),
          .latent = share([](const FaultCounts& c) { return c.faults - c.undetected - c.latent; }, covered)};
}

}  // namespace dtof
