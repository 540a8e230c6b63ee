// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "dtof/photon/sensor_model.hpp"

namespace dtof {

/// What one check found over its grid of inputs.
struct StabilityResult {
  std::string what;       ///< function or model
  std::string inputs;     ///< what was swept
  std::string reference;  ///< what it was compared with
  std::uint64_t cases;    ///< values compared
  double error;           ///< largest; NaN in a result counts as infinite
  double limit;           ///< accepted
  std::string unit;       ///< of error and limit

  [[nodiscard]] bool passed() const { return error <= limit; }
};

using Real = boost::multiprecision::cpp_bin_float_50;

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kSixSigma = 6.0;

/// Collects the largest error of a row.
class Largest {
 public:
  void add(double error) {
    ++cases_;
    // Written so that a NaN is the worst.
    error_ = error <= error_ ? error_ : (std::isnan(error) ? kInfinity : error);
  }
  /// |value - reference| / scale, in units of the last place of a double where scale is the reference.
  void add(double value, const Real& reference, const Real& scale) {
    if (!std::isfinite(value)) {
      add(kInfinity);
      return;
    }
    const Real difference = abs(Real(value) - reference);
    add(difference == 0 ? 0.0 : static_cast<double>(difference / scale));
  }
  void relative(double value, const Real& reference) { add(value, reference, abs(reference)); }

  [[nodiscard]] StabilityResult row(std::string what, std::string inputs, std::string reference, double limit,
                                    std::string unit = "relative") const {
    return {std::move(what), std::move(inputs), std::move(reference), cases_, error_, limit, std::move(unit)};
  }

 private:
  std::uint64_t cases_ = 0;
  double error_ = 0.0;
};

/// P(N >= k), N Poisson.
inline Real exact_at_least(int k, const Real& mean) {
  return mean == 0 ? Real(k == 0 ? 1 : 0) : (k == 0 ? Real(1) : boost::math::gamma_p(Real(k), mean));
}

inline Real exact_normal_share(const Real& from, const Real& to) {
  const Real root = sqrt(Real(2));
  // Both tails on the side where they are small.
  return from > 0 ? (boost::math::erfc(from / root) - boost::math::erfc(to / root)) / 2
                  : (boost::math::erfc(-to / root) - boost::math::erfc(-from / root)) / 2;
}

inline SensorModel sensor_of(int np, double fwhm_bins) {
  SensorModel sensor;
  sensor.np = np;
  sensor.pulse_fwhm_s = fwhm_bins * sensor.time_resolution_s();
  return sensor;
}

/// A limit is at most ten times what is observed, so that a loss of accuracy is noticed; random draws have
/// limits of six standard deviations (a right model exceeds them twice in 1e9 cases), whatever was drawn.
inline void expect_stable(const std::vector<StabilityResult>& results) {
  for (const StabilityResult& result : results) {
    SCOPED_TRACE(result.what + " over " + result.inputs + ", against " + result.reference + ", in " +
                 result.unit);
    EXPECT_GT(result.cases, 0U);
    EXPECT_LE(result.error, result.limit);
    if (result.unit != "standard deviations") {
      EXPECT_LE(result.limit, 10.0 * result.error);
    }
  }
}

}  // namespace dtof
