// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/optimised_code.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

#include "dtof/core/error.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

// With a strong signal no wrong place counts: E = N / 2 / (S 2 pi g / T)^2 for harmonic 1. N is S and the
// dark counts and sunlight.
TEST(OptimisedCode, ExpectedErrorOfAStrongSignalIsTheBoundOfSmallErrors) {
  SensorModel sensor;
  sensor.signal_events_1m = 1000.0;
  const double half_range_m = 0.25 * 299'792'458.0 * 45e-9;
  const double signal = 3333.0 * 1000.0 / (half_range_m * half_range_m);
  const double events = signal + 3333.0 * (0.15 / 14.0 * 50.0 + 1e4 * 45e-9);
  const double turn = 2.0 * std::numbers::pi / 1024.0;
  const double sigma = 2.0 / 2.354820045 / 45.0 * 1024.0;
  const double slope = signal * turn * std::exp(-0.5 * turn * sigma * turn * sigma);
  const double expected = 0.5 * events / (slope * slope);
  EXPECT_NEAR(expected_square_error(sensor, 50.0, std::vector{1}), expected, 1e-6 * expected);
}

// Harmonic 2 alone cannot tell places half a range apart: the place at 512 codes is wrong with probability
// 1/2.
TEST(OptimisedCode, AmbiguousHarmonicsCostTheirWrongPlaces) {
  const SensorModel sensor;
  EXPECT_GT(expected_square_error(sensor, 50.0, std::vector{2}), 0.9 * 500.0 * 500.0);
}

TEST(OptimisedCode, NoReplacementOfAHarmonicIsBetter) {
  const SensorModel sensor;
  const std::vector<int> found = optimised_harmonics(sensor, 8);
  EXPECT_THAT(found, ElementsAre(1, 2, 5, 6));  // the best of all 715 sets, by a calculation of its own
  const double least = mean_square_error(sensor, found);
  EXPECT_LE(least, mean_square_error(sensor, std::vector{1, 2, 4, 8}));  // Gray-Fourier
  for (std::size_t place = 0; place < found.size(); ++place) {
    for (int harmonic = 1; harmonic <= largest_harmonic(sensor); ++harmonic) {
      std::vector<int> other = found;
      other[place] = harmonic;
      if (std::ranges::count(other, harmonic) == 1) {
        EXPECT_GE(mean_square_error(sensor, other), least) << place << " " << harmonic;
      }
    }
  }
}

// Where the pulse leaves as many harmonics as the code has, there is no choice.
TEST(OptimisedCode, TakesAllHarmonicsOfAWidePulse) {
  SensorModel sensor;
  sensor.pulse_fwhm_s = 12e-9;  // sigma 5.1 ns; a quarter of the range has 2.2 of them
  ASSERT_EQ(largest_harmonic(sensor), 2);
  EXPECT_THAT(optimised_harmonics(sensor, 4), ElementsAre(1, 2));
}

TEST(OptimisedCode, IsAFourierCodeOfFourBits) {
  const SensorModel sensor;
  const std::unique_ptr<Rival> code = make_optimised_code(sensor, 8);
  EXPECT_EQ(code->bits_per_pixel(), 8 * 13 + 1);
  const std::vector<Detection> pixel = noise_free_pulse(sensor, 400.0, 1500.0, 1);
  EXPECT_NEAR(code->decode(read_one_frame(*code, pixel)).position, 400.0, 2.0);
  EXPECT_THAT([&] { (void)make_optimised_code(sensor, 7); },
              ThrowsMessage<InputError>(HasSubstr("7 counters, but it must be an even number")));
}

}  // namespace
}  // namespace dtof
