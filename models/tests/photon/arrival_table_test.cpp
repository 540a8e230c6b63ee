// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/arrival_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/physics.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

const PixelRates kPixel{.background = 0.15, .signal = 0.3, .centre_bins = 197.35};

TEST(ArrivalTable, IsTheCumulativeMeanAtEveryBin) {
  const SensorModel sensor;
  const double sigma = pulse_sigma_s(sensor.pulse_fwhm_s) / sensor.time_resolution_s();
  ArrivalTable table(sensor);
  for (const PixelRates& rates : {kPixel, PixelRates{.background = 0.02, .signal = 5.0, .centre_bins = 3.0},
                                  PixelRates{.background = 2.0, .signal = 0.01, .centre_bins = 1020.0}}) {
    table.build(rates);
    const auto means = bin_means(1024, rates.background, rates.signal, rates.centre_bins, sigma);
    double before = 0.0;
    for (std::size_t bin = 0; bin < means.size(); ++bin) {
      ASSERT_NEAR(table.cumulative(static_cast<double>(bin)), before,
                  1e-4 * (rates.signal + rates.background))
          << bin;
      before += means[bin];
    }
    EXPECT_NEAR(table.total(), before, 1e-8 * before);
    EXPECT_EQ(table.total(), table.events());
  }
}

TEST(AtLeast, IsTheUpperTailOfPoisson) {
  for (const double mean : {1e-6, 0.3, 2.0, 30.0}) {
    EXPECT_EQ(at_least(0, mean), 1.0);
    EXPECT_NEAR(at_least(1, mean), -std::expm1(-mean), 1e-14);
    EXPECT_NEAR(at_least(2, mean), -std::expm1(-mean) - mean * std::exp(-mean), 1e-14);
  }
}

TEST(PixelRates, AreDarkUnlessSaidOtherwise) {
  const PixelRates dark;
  EXPECT_EQ(dark.background, 0.0);
  EXPECT_EQ(dark.signal, 0.0);
}

TEST(ArrivalTable, KeptEventsAreTheExpectedDetections) {
  SensorModel sensor;
  for (const int slots : {1, 2, 4}) {
    sensor.slots = slots;
    const std::vector<double> expected = expected_detections(sensor, kPixel);
    ArrivalTable table(sensor);
    table.build_kept(kPixel, slots);
    double before = 0.0;
    for (std::size_t code = 0; code < expected.size(); ++code) {
      ASSERT_NEAR(table.cumulative(static_cast<double>(code)), before, 2e-5) << code;
      before += expected[code];
    }
    EXPECT_NEAR(table.total(), kept_events(table.events(), slots), 1e-9);
  }
}

TEST(ArrivalTable, InverseUndoesCumulative) {
  const SensorModel sensor;
  ArrivalTable table(sensor);
  for (const double background : {0.0, 0.15, 50.0}) {
    table.build({.background = background, .signal = 0.3, .centre_bins = 500.5});
    double before = 0.0;
    for (int i = 0; i < 100000; ++i) {
      const double point = table.total() * (i + 0.5) / 100000.0;
      const double time = table.inverse(point);
      ASSERT_GE(time, before - 1e-9);
      ASSERT_LT(time, 1024.0);
      ASSERT_NEAR(table.cumulative(time), point, 1e-4 * table.total()) << background << " " << i;
      before = time;
    }
  }
}

TEST(ArrivalTable, DisplacementIsAThousandthOfABin) {
  const SensorModel sensor;
  ArrivalTable table(sensor);
  table.build(kPixel);
  EXPECT_GT(table.displacement(), 0.0);
  EXPECT_LT(table.displacement(), 2e-3);
  table.build({.background = 0.0, .signal = 0.3, .centre_bins = 500.5});
  EXPECT_LT(table.displacement(), 4e-3);
  table.build({.background = 1.0, .signal = 0.0, .centre_bins = 0.0});
  EXPECT_EQ(table.displacement(), 0.0);
}

TEST(ArrivalTable, IsRebuiltForOtherRatesOnly) {
  const SensorModel sensor;
  ArrivalTable table(sensor);
  table.build(kPixel);
  const double total = table.total();
  table.build(kPixel);
  EXPECT_EQ(table.total(), total);
  table.build_kept(kPixel, 1);
  EXPECT_LT(table.total(), total);
  table.build(kPixel);
  EXPECT_EQ(table.total(), total);
}

}  // namespace
}  // namespace dtof
