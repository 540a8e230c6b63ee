// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/cramer_rao.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

void require(bool legal, std::string_view name, double value, std::string_view rule) {
  if (!legal) {
    throw InputError(fmt::format("{} is {}, but must be {}", name, value, rule));
  }
}

void validate(const PulseObservation& o) {
  const auto not_negative = [](double value) { return std::isfinite(value) && value >= 0.0; };
  require(not_negative(o.signal_events), "number of signal events", o.signal_events, "0 or more");
  require(not_negative(o.background_events), "number of background events", o.background_events, "0 or more");
  require(std::isfinite(o.centre_bins), "pulse centre", o.centre_bins, "finite");
  require(std::isfinite(o.sigma_bins) && o.sigma_bins > 0.0, "pulse sigma", o.sigma_bins, "above 0");
  require(o.np >= 1 && o.np <= 16, "NP", o.np, "1 to 16");
  require(not_negative(o.acquisitions), "number of acquisitions", o.acquisitions, "0 or more");
  require(o.kept_events >= 0 && o.kept_events <= 16, "number of kept events", o.kept_events, "0 to 16");
}

double normal_density(double z) {
  return std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

// P(low < Z <= high); from the nearer tail, where the difference does not cancel.
double normal_share(double low, double high) {
  if (low > 0.0) {
    return normal_share(-high, -low);
  }
  return 0.5 * (std::erfc(-high / std::numbers::sqrt2) - std::erfc(-low / std::numbers::sqrt2));
}

// Share of the pulse in a bin and its derivative with respect to the arrival time.
struct BinShare {
  double share;
  double slope;
};
BinShare bin_share(const PulseObservation& o, int bin) {
  const double begin = bin - o.centre_bins;
  if (o.response) {
    const auto share_from = [&](double time) {
      return o.response->share_before(time + 1.0) - o.response->share_before(time);
    };
    return {share_from(begin), share_from(begin - 0.5) - share_from(begin + 0.5)};
  }
  const double low = begin / o.sigma_bins;
  const double high = (bin + 1 - o.centre_bins) / o.sigma_bins;
  return {normal_share(low, high), (normal_density(low) - normal_density(high)) / o.sigma_bins};
}

// P(N <= count) for a Poisson number N of the given mean.
double poisson_cdf(int count, double mean) {
  double term = std::exp(-mean);
  double sum = term;
  for (int k = 1; k <= count; ++k) {
    term *= mean / k;
    sum += term;
  }
  return sum;
}

// Mean over a bin of the probability of fewer than `kept` events before a point in it, for `earlier` events
// before the bin and `rate` in it. Its product with `rate` is E[min(N, kept)] at the bin's end minus at its
// begin; below kSmallRate that difference would cancel, and the midpoint is exact to rate^2 / 24.
constexpr double kSmallRate = 1e-5;
double mean_weight(int kept, double earlier, double rate) {
  if (rate < kSmallRate) {
    return poisson_cdf(kept - 1, earlier + 0.5 * rate);
  }
  double kept_in_bin = 0.0;
  for (int k = 0; k < kept; ++k) {
    kept_in_bin += poisson_cdf(k, earlier) - poisson_cdf(k, earlier + rate);
  }
  return kept_in_bin / rate;
}

}  // namespace

double cramer_rao_bound(const PulseObservation& observation) {
  validate(observation);
  const int code_count = 1 << observation.np;
  const double background = observation.background_events / code_count;

  double information = 0.0;
  double earlier = 0.0;
  for (int bin = 0; bin < code_count - 1; ++bin) {
    const BinShare pulse = bin_share(observation, bin);
    const double rate = observation.signal_events * pulse.share + background;
    const double slope = observation.signal_events * pulse.slope;
    if (rate > 0.0) {
      const double weight =
          observation.kept_events == 0 ? 1.0 : mean_weight(observation.kept_events, earlier, rate);
      information += weight * slope * (slope / rate);
    }
    earlier += rate;
  }
  information *= observation.acquisitions;
  return information > 0.0 ? 1.0 / std::sqrt(information) : std::numeric_limits<double>::infinity();
}

}  // namespace dtof
