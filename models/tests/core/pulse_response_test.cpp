// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/pulse_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

TEST(PulseResponse, BoxHasTheMomentsOfAUniformDistribution) {
  // Zeros at the ends do not count.
  const PulseResponse box({0.0, 0.0, 3.0, 3.0, 3.0, 3.0, 0.0}, 0.5);
  EXPECT_DOUBLE_EQ(box.begin(), -1.0);
  EXPECT_DOUBLE_EQ(box.end(), 1.0);
  EXPECT_DOUBLE_EQ(box.standard_deviation(), 2.0 / std::sqrt(12.0));
  EXPECT_DOUBLE_EQ(box.full_width_at_half_maximum(), 2.0);
  EXPECT_DOUBLE_EQ(box.share_before(-1.0), 0.0);
  EXPECT_DOUBLE_EQ(box.share_before(0.5), 0.75);
  EXPECT_DOUBLE_EQ(box.share_before(9.0), 1.0);
  EXPECT_DOUBLE_EQ(box.quantile(0.75), 0.5);
  EXPECT_DOUBLE_EQ(box.quantile(0.0), -1.0);
  EXPECT_DOUBLE_EQ(box.quantile(1.0), 1.0);
}

TEST(PulseResponse, CentroidIsAtZeroAndTheInverseInverts) {
  const PulseResponse two({1.0, 0.0, 0.0, 3.0}, 2.0);
  // Centroid (1 * 1 + 3 * 7) / 4 = 5.5 behind the first edge.
  EXPECT_DOUBLE_EQ(two.begin(), -5.5);
  EXPECT_DOUBLE_EQ(two.share_before(-1.0), 0.25);
  EXPECT_DOUBLE_EQ(two.full_width_at_half_maximum(), 2.0) << "the first peak is below half the maximum";
  for (const double share : {0.01, 0.2, 0.26, 0.9}) {
    EXPECT_NEAR(two.share_before(two.quantile(share)), share, 1e-15);
  }
  const PulseResponse both({2.0, 0.0, 0.0, 3.0}, 2.0);
  EXPECT_NEAR(both.full_width_at_half_maximum(), 2.0 * (3.0 + 0.25 + 0.5), 1e-12);
}

TEST(PulseResponse, BroadeningAddsVariancesAndMakesAGaussian) {
  const PulseResponse box(std::vector<double>(40, 1.0), 0.1);
  const PulseResponse broad = box.broadened(0.7);
  EXPECT_NEAR(broad.standard_deviation(), std::hypot(box.standard_deviation(), 0.7), 1e-4);
  const PulseResponse gaussian = PulseResponse({1.0}, 0.01).broadened(0.5);
  for (const double z : {-2.0, -0.3, 0.0, 1.1}) {
    EXPECT_NEAR(gaussian.share_before(0.5 * z), 0.5 * std::erfc(-z / std::sqrt(2.0)), 3e-5);
  }
  EXPECT_NEAR(gaussian.full_width_at_half_maximum(), 0.5 * 2.0 * std::sqrt(2.0 * std::log(2.0)), 1e-3);
}

TEST(PulseResponse, ScalesTime) {
  const PulseResponse scaled = PulseResponse({1.0, 2.0, 1.0}, 8e-12).scaled(1e12);
  EXPECT_NEAR(scaled.begin(), -12.0, 1e-12);
  EXPECT_NEAR(scaled.end(), 12.0, 1e-12);
}

TEST(PulseResponse, RefusesWhatIsNoPulse) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PulseResponse({}, 1.0), InputError);
  EXPECT_THROW(PulseResponse({0.0, 0.0}, 1.0), InputError);
  EXPECT_THROW(PulseResponse({1.0, -1.0, 1.0}, 1.0), InputError);
  EXPECT_THROW(PulseResponse({1.0, nan}, 1.0), InputError);
  EXPECT_THROW(PulseResponse({1e308, 1e308}, 1.0), InputError);
  EXPECT_THROW(PulseResponse({1.0}, 0.0), InputError);
  EXPECT_THROW(PulseResponse({1.0}, nan), InputError);
}

}  // namespace
}  // namespace dtof
