// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/equi_depth_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/rival/equi_depth.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

/// Mean events before a place of the range, in codes from its begin on; the pulse's mean is in the middle of
/// code `centre`.
double events_before(const SensorModel& sensor, double place, double centre, double signal,
                     double background) {
  const double sigma = sensor.pulse_sigma_s() / sensor.time_resolution_s();
  return background * place / std::ldexp(1.0, sensor.np) +
         signal * 0.5 * std::erfc((centre + 0.5 - place) / (sigma * std::numbers::sqrt2));
}

/// Boundaries of 16 parts of equal share, by bisection.
std::vector<double> sixteen_parts(const std::function<double(double)>& detections_before) {
  std::vector<double> boundaries;
  for (int part = 1; part < 16; ++part) {
    double low = 0.0;
    double high = 1024.0;
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (detections_before(middle) < part / 16.0 * detections_before(1024.0) ? low : high) = middle;
    }
    boundaries.push_back(low);
  }
  return boundaries;
}

TEST(EquiDepthFit, FindsThePulseOfCalculatedBoundaries) {
  SensorModel sensor;
  sensor.dead_time_s = 0.0;  // free-running without dead time keeps all events
  for (const Capture capture : {Capture::kFirstEvents, Capture::kFreeRunning}) {
    const EquiDepthFit fit(sensor, capture);
    for (const double centre : {150.0, 400.3, 800.0}) {
      const std::vector<double> boundaries =
          sixteen_parts([&](double place) { return events_before(sensor, place, centre, 0.025, 0.05); });
      EXPECT_NEAR(fit.decode(boundaries).position, centre, 2.0) << centre;
      EXPECT_GT(fit.decode(boundaries).confidence, 0.0);
    }
  }
}

// A SPAD that detects one event of an acquisition: 1 - exp(-V) detections before a place, V the events before
// it. With 3 background events per acquisition the narrowest parts are those where the range begins.
TEST(EquiDepthFit, SeesThroughPileUp) {
  SensorModel sensor;
  sensor.slots = 1;
  const EquiDepthFit fit(sensor, Capture::kFirstEvents);
  const std::vector<double> boundaries = sixteen_parts(
      [&](double place) { return -std::expm1(-events_before(sensor, place, 600.0, 0.6, 3.0)); });
  EXPECT_LT(densest_place(boundaries, 1024).position, 300.0);
  EXPECT_NEAR(fit.decode(boundaries).position, 600.0, 5.0);
}

// The chip is that of HEDH.
TEST(FittedEquiDepth, HasTheWordsOfItsBinners) {
  const SensorModel sensor;
  const std::unique_ptr<Rival> fitted = make_fitted_equi_depth(sensor, 16);
  const std::unique_ptr<Rival> binners = make_hierarchical_equi_depth(sensor, {.parts = 16});
  const std::vector<Detection> pixel = noise_free_pulse(sensor, 300.0, 1500.0, 1);
  EXPECT_EQ(fitted->bits_per_pixel(), 150);
  EXPECT_EQ(read_one_frame(*fitted, pixel), read_one_frame(*binners, pixel));
  EXPECT_NEAR(fitted->decode(read_one_frame(*fitted, pixel)).position, 300.0, 10.0);
  EXPECT_EQ(fitted->decode(read_one_frame(*fitted, {})).confidence, 0.0);
  EXPECT_THROW((void)make_fitted_equi_depth(sensor, 6), InputError);
}

}  // namespace
}  // namespace dtof
