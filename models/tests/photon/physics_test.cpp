// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/physics.hpp"

#include <gtest/gtest.h>

namespace dtof {
namespace {

TEST(Physics, DerivedSignalOfTheSpecification) {
  const OpticalInputs inputs;
  EXPECT_NEAR(signal_events_per_pulse(inputs, 1.0, 1.0), 0.200, 0.001);
}

TEST(Physics, SignalFallsWithTheSquareOfDistanceAndGrowsWithReflectivity) {
  const OpticalInputs inputs;
  const double reference = signal_events_per_pulse(inputs, 1.0, 1.0);
  EXPECT_NEAR(signal_events_per_pulse(inputs, 3.0, 1.0), reference / 9.0, 1e-12);
  EXPECT_NEAR(signal_events_per_pulse(inputs, 0.5, 0.25), reference, 1e-12);
  EXPECT_EQ(signal_events_per_pulse(inputs, 1.0, 0.0), 0.0);
}

TEST(Physics, DerivedBackgroundOfTheSpecification) {
  const OpticalInputs inputs;  // 1 nm filter
  EXPECT_NEAR(sunlight_events_per_window(inputs, 14.0, 1.0), 0.042, 0.0005);
  EXPECT_NEAR(sunlight_events_per_window(inputs, 14.0, 0.5), 0.021, 0.00025);
  EXPECT_EQ(sunlight_events_per_window(inputs, 0.0, 1.0), 0.0);
}

TEST(Physics, BackgroundAddsDarkCounts) {
  const OpticalInputs inputs;
  EXPECT_DOUBLE_EQ(dark_events_per_window(inputs), 1e4 * 45e-9);
  EXPECT_DOUBLE_EQ(background_events_per_window(inputs, 0.0, 1.0), 4.5e-4);
  EXPECT_DOUBLE_EQ(background_events_per_window(inputs, 14.0, 1.0),
                   sunlight_events_per_window(inputs, 14.0, 1.0) + 4.5e-4);
}

TEST(Physics, PulseEnergyIsThatOfAGaussian) {
  // 20 W peak, 2 ns FWHM: 1.0645 x 40 nJ.
  EXPECT_NEAR(pulse_energy_j(OpticalInputs()), 42.58e-9, 0.01e-9);
  EXPECT_NEAR(photon_energy_j(OpticalInputs()), 2.195e-19, 0.001e-19);
}

TEST(Physics, ArrivalTime) {
  EXPECT_NEAR(arrival_centre_s(1.0, 2e-9), 8.671e-9, 0.001e-9);
  EXPECT_NEAR(pulse_sigma_s(2.3548), 1.0, 1e-5);
}

}  // namespace
}  // namespace dtof
