// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/expected_detections.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <numeric>

#include "dtof/core/error.hpp"
#include "dtof/core/log_gamma.hpp"

namespace dtof {
namespace {

/// Share of a standard normal distribution between `from` and `to`; the tail on the pulse's side keeps small
/// shares.
double normal_share(double from, double to) {
  const auto upper = [](double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); };
  return from > 0.0 ? upper(from) - upper(to) : upper(-to) - upper(-from);
}

/// P(N > k at mean `after`) - P(N > k at mean `before`) for Poisson numbers N.
double slot_probability(int k, double before, double after) {
  using Policy = boost::math::policies::policy<
      boost::math::policies::promote_double<false>,
      boost::math::policies::underflow_error<boost::math::policies::ignore_error>>;
  if (k == 0) {
    return std::exp(-before) * -std::expm1(-(after - before));
  }
  const double step = after - before;
  if (step < 1e-3 * before && step < 0.01) {
    // The difference would cancel: Simpson's rule on the density mean^k exp(-mean) / k!, whose error is below
    // (step / before)^4.
    const auto density = [k](double mean) {
      return std::exp(k * std::log(mean) - mean - log_gamma(k + 1.0));
    };
    return step / 6.0 * (density(before) + 4.0 * density(before + 0.5 * step) + density(after));
  }
  // The smaller of both tails, so that the difference does not cancel.
  const double shape = k + 1.0;
  const double difference =
      before > shape
          ? boost::math::gamma_q(shape, before, Policy()) - boost::math::gamma_q(shape, after, Policy())
          : boost::math::gamma_p(shape, after, Policy()) - boost::math::gamma_p(shape, before, Policy());
  return std::max(difference, 0.0);
}

}  // namespace

std::vector<std::vector<double>> expected_slot_detections(const SensorModel& model, const PixelRates& rates) {
  if (model.dead_time_s > 0.0 || model.afterpulse_probability > 0.0 || model.binning > 1 ||
      model.coincidence_window_s || !model.surroundings.none()) {
    throw InputError(
        "expected detections have no dead time, afterpulsing, binning, coincidence or surroundings: use the "
        "exact "
        "photon model");
  }
  const auto codes = std::size_t{1} << static_cast<unsigned>(model.np);
  const double resolution = model.time_resolution_s();
  const double gate_begin = model.time_gate ? model.time_gate->begin_s / resolution : 0.0;
  const double gate_end = model.time_gate ? model.time_gate->end_s / resolution : static_cast<double>(codes);
  const double sigma = model.pulse_sigma_s() / resolution;
  std::vector<std::vector<double>> slots(static_cast<std::size_t>(model.slots),
                                         std::vector<double>(codes, 0.0));
  const std::shared_ptr<const PulseResponse> response = model.pulse_response_bins();
  std::vector<double> boundaries;
  if (model.tdc_codes) {
    boundaries = model.tdc_codes->boundaries(0, model.np);
  } else {
    boundaries.resize(codes + 1);
    std::iota(boundaries.begin(), boundaries.end(), 0.0);
  }
  double before = 0.0;
  for (std::size_t code = 0; code < codes; ++code) {
    const double begin = std::clamp(boundaries[code], gate_begin, gate_end);
    const double end = std::clamp(boundaries[code + 1], gate_begin, gate_end);
    double mean = rates.background * (end - begin) / static_cast<double>(codes);
    if (rates.signal > 0.0 && end > begin) {
      const double from = begin - rates.centre_bins;
      const double to = end - rates.centre_bins;
      mean += rates.signal * (response ? response->share_before(to) - response->share_before(from)
                                       : normal_share(from / sigma, to / sigma));
    }
    for (std::size_t k = 0; mean > 0.0 && k < slots.size(); ++k) {
      slots[k][code] = slot_probability(static_cast<int>(k), before, before + mean);
    }
    before += mean;
  }
  return slots;
}

std::vector<double> expected_detections(const SensorModel& model, const PixelRates& rates) {
  std::vector<std::vector<double>> slots = expected_slot_detections(model, rates);
  std::vector<double> sum = std::move(slots.front());
  for (std::size_t k = 1; k < slots.size(); ++k) {
    for (std::size_t code = 0; code < sum.size(); ++code) {
      sum[code] += slots[k][code];
    }
  }
  return sum;
}

}  // namespace dtof
