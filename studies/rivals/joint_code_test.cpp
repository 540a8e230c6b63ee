// SPDX-License-Identifier: Apache-2.0
#include "rivals/joint_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

#include "dtof/metrics/error_estimates.hpp"

namespace dtof {
namespace {

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(JointCode, ShortestPulseIsAsStrongAsThePeak) {
  const std::vector<double> drive = shortest_pulse({.codes = 8, .peak = 3.0});
  const std::vector<double> expected = {0.375, 0.375, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t n = 0; n < drive.size(); ++n) {
    EXPECT_NEAR(drive[n], expected[n], 1e-15) << n;
  }
}

// A single code behind the low-pass is a Gaussian of that standard deviation.
TEST(JointCode, LightIsTheDriveBehindTheLowPass) {
  const LaserLimits limits{.codes = 256, .blur = 6.0, .peak = 256.0};
  std::vector<double> drive(256, 0.0);
  drive[100] = 1.0;
  const std::vector<double> light = blurred_light(limits, drive);
  EXPECT_NEAR(sum_of(light), 1.0, 1e-9);
  for (const int offset : {-12, -3, 0, 5, 20}) {
    const double z = offset / limits.blur;
    EXPECT_NEAR(light[static_cast<std::size_t>(100 + offset)],
                std::exp(-0.5 * z * z) / (limits.blur * std::sqrt(2.0 * std::numbers::pi)), 1e-7)
        << offset;
  }
}

// Strong light: what is left is the noise of the phases, and each harmonic tells the place by its own.
TEST(JointCode, ErrorInStrongLightIsThatOfThePhases) {
  const LaserLimits limits{.peak = 1024.0, .detections = 1e6};
  double information = 0.0;
  for (const double harmonic : {1.0, 3.0}) {
    const double angle = 2.0 * std::numbers::pi * harmonic / limits.codes;  // in a code
    const double modulation = limits.signal_share * std::exp(-0.5 * std::pow(angle * limits.blur, 2));
    const double phase_noise = 1.0 / (modulation * std::sqrt(2.0 * limits.detections));
    information += std::pow(angle / phase_noise, 2);
  }
  EXPECT_NEAR(expected_square_error(limits, {shortest_pulse(limits), {1, 3}}) * information, 1.0, 1e-6);
}

// The third harmonic alone has three places that look alike, a third of the range apart.
TEST(JointCode, ErrorCountsPlacesThatLookAlike) {
  const LaserLimits limits{.peak = 1024.0, .detections = 1e4};
  EXPECT_GT(expected_square_error(limits, {shortest_pulse(limits), {3}}), 1e4);
  EXPECT_LT(expected_square_error(limits, {shortest_pulse(limits), {1, 3}}), 10.0);
}

TEST(JointCode, LightStaysWithinTheLimits) {
  const LaserLimits limits{.codes = 256, .blur = 5.0, .peak = 8.0, .detections = 1000.0, .signal_share = 0.3};
  const LaserCode code = joint_code(limits, 8, 1);
  EXPECT_NEAR(sum_of(code.drive), 1.0, 1e-9);
  EXPECT_GE(*std::ranges::min_element(code.drive), 0.0);
  EXPECT_LE(*std::ranges::max_element(code.drive), limits.peak / limits.codes * (1.0 + 1e-12));
  ASSERT_EQ(code.harmonics.size(), 4U);
  std::vector<int> sorted = code.harmonics;
  std::ranges::sort(sorted);
  EXPECT_TRUE(std::ranges::adjacent_find(sorted) == sorted.end());
}

// A peak of four times the mean makes the shortest pulse as long as a quarter of the range.
TEST(JointCode, LightIsMuchBetterThanALongPulse) {
  const LaserLimits limits{.codes = 256, .blur = 5.0, .peak = 4.0, .detections = 1000.0, .signal_share = 0.3};
  EXPECT_LT(expected_square_error(limits, joint_code(limits, 8, 1)),
            0.5 * expected_square_error(limits, best_code_of_the_shortest_pulse(limits, 8)));
}

TEST(JointCode, IsNoWorseThanTheCodeOfTheShortestPulse) {
  for (const double peak : {4.0, 256.0}) {
    const LaserLimits limits{
        .codes = 256, .blur = 5.0, .peak = peak, .detections = 1000.0, .signal_share = 0.3};
    const LaserCode alone = best_code_of_the_shortest_pulse(limits, 8);
    const LaserCode fourier{shortest_pulse(limits), {1, 2, 3, 4}};
    EXPECT_LE(expected_square_error(limits, alone), expected_square_error(limits, fourier)) << peak;
    EXPECT_LE(expected_square_error(limits, joint_code(limits, 8, 1)), expected_square_error(limits, alone))
        << peak;
  }
}

// The equation and the simulated photons are independent of each other. The equation's noise is that of
// photons spread over the range, so most photons are background here.
TEST(JointCode, SimulatedErrorsAreThoseOfTheEquation) {
  for (const double peak : {5.0, 1024.0}) {
    const LaserLimits limits{.peak = peak, .detections = 20'000.0, .signal_share = 0.1};
    for (const LaserCode& code :
         {joint_code(limits, 8, 1), LaserCode{shortest_pulse(limits), {1, 2, 3, 4}}}) {
      const Estimate error = estimate_root_mean_square(laser_code_errors(limits, code, 600, 1, 0));
      const double expected = std::sqrt(expected_square_error(limits, code));
      EXPECT_LT(error.interval.low, 1.1 * expected) << peak;
      EXPECT_GT(error.interval.high, 0.9 * expected) << peak;
    }
  }
}

TEST(JointCode, PlacesHaveNoSystematicError) {
  const LaserLimits limits{.detections = 4000.0, .signal_share = 0.9};
  const std::vector<double> errors = laser_code_errors(limits, joint_code(limits, 8, 1), 500, 2, 0);
  const double mean = sum_of(errors) / static_cast<double>(errors.size());
  const double deviation = estimate_standard_deviation(errors).value;
  EXPECT_LT(std::abs(mean), 4.0 * deviation / std::sqrt(static_cast<double>(errors.size())));
}

TEST(JointCode, DoesNotDependOnTheThreads) {
  const LaserLimits limits{.codes = 256, .blur = 5.0, .detections = 500.0};
  const LaserCode code = best_code_of_the_shortest_pulse(limits, 4);
  EXPECT_EQ(laser_code_errors(limits, code, 50, 1, 1), laser_code_errors(limits, code, 50, 1, 3));
}

}  // namespace
}  // namespace dtof
