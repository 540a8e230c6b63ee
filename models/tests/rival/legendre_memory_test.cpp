// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/legendre_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/rival/linear_code.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(LegendrePolynomials, HaveTheirClosedForms) {
  for (const double x : {0.0, 0.1, 0.25, 0.5, 0.77, 1.0}) {
    const std::vector<double> values = legendre_polynomials(5, x);
    ASSERT_EQ(values.size(), 5U);
    EXPECT_DOUBLE_EQ(values[0], 1.0);
    EXPECT_NEAR(values[1], 2.0 * x - 1.0, 1e-12);
    EXPECT_NEAR(values[2], 6.0 * x * x - 6.0 * x + 1.0, 1e-12);
    EXPECT_NEAR(values[3], ((20.0 * x - 30.0) * x + 12.0) * x - 1.0, 1e-12);
    EXPECT_NEAR(values[4], (((70.0 * x - 140.0) * x + 90.0) * x - 20.0) * x + 1.0, 1e-12);
  }
  EXPECT_THAT(legendre_polynomials(32, 1.0), Each(1.0));
  EXPECT_THAT(legendre_polynomials(1, 0.3), ElementsAre(1.0));
}

// np 3, d 3, h 7: the scales are 7 sqrt(1/5) = 3.13, 7 sqrt(3/5) = 5.42 and 7; 2x - 1 is -7/8, -5/8 and so
// on.
TEST(LegendreWeights, AreTheRoundedPolynomials) {
  EXPECT_THAT(legendre_weights(3, 3, 4), ElementsAre(3, -5, 5, 3, -3, 1, 3, -2, -2, 3, -1, -3,  //
                                                     3, 1, -3, 3, 2, -2, 3, 3, 1, 3, 5, 5));
  EXPECT_THAT([] { (void)legendre_weights(3, 1, 4); },
              ThrowsMessage<InputError>(HasSubstr("order 1, numbers of 4 bits")));
  EXPECT_THAT([] { (void)legendre_weights(3, 8, 13); },
              ThrowsMessage<InputError>(HasSubstr("order 8, numbers of 13 bits")));
}

// Equal noise in all counters from flat background, and no correlation: what the matcher takes for granted.
TEST(LegendreWeights, AreOrthogonalAndOfOneLength) {
  constexpr std::size_t kOrder = 16;
  const auto product = [](const std::vector<std::int16_t>& weights, std::size_t j, std::size_t k) {
    double sum = 0.0;
    for (std::size_t x = 0; x < 1024; ++x) {
      sum += static_cast<double>(weights[x * kOrder + j]) * weights[x * kOrder + k];
    }
    return sum;
  };
  for (const auto& [bits, tolerance] : {std::pair{12, 0.003}, {8, 0.02}, {4, 0.25}}) {
    const std::vector<std::int16_t> weights = legendre_weights(10, kOrder, bits);
    const double height = (1 << (bits - 1)) - 1;
    const double length = height * height * 1024.0 / (2.0 * kOrder - 1.0);
    for (std::size_t j = 0; j < kOrder; ++j) {
      for (std::size_t k = 0; k < kOrder; ++k) {
        EXPECT_NEAR(product(weights, j, k) / length, j == k ? 1.0 : 0.0, j == 0 && k == 0 ? 0.4 : tolerance)
            << bits << " bits: " << j << " " << k;
      }
    }
  }
}

TEST(LegendreWeights, RepeatAfterHalfOfTheRange) {
  const std::vector<std::int16_t> weights = legendre_weights(8, 9, 4);
  for (std::size_t x = 0; x < 128; ++x) {
    for (std::size_t k = 0; k < 9; ++k) {
      EXPECT_EQ(weights[x * 9 + k], (k % 2 == 0 ? 1 : -1) * weights[(255 - x) * 9 + k]) << x << " " << k;
    }
  }
}

// Limits of 5 bits with sign are -15 and 15: three detections of code 0 reach them.
TEST(LegendreMemory, FullCountersAreThoseOfALinearCode) {
  SensorModel sensor;
  sensor.np = 3;
  LinearCode code{.counters = 3, .weights = legendre_weights(3, 3, 4), .count_bits = 5, .is_signed = true};
  const std::vector<Detection> detections = one_each(std::array{0, 0, 0, 0, 6, 7});
  EXPECT_THAT(read_one_frame(*make_linear_code(sensor, code), detections), ElementsAre(9, -15, 15));
  code.full = FullCounter::kStays;
  EXPECT_THAT(read_one_frame(*make_linear_code(sensor, code), detections), ElementsAre(15, -12, 15))
      << "7 is no detection";
}

TEST(LegendreMemory, AddsItsNumbersAndNoFrameFillsThem) {
  SensorModel sensor;
  sensor.acquisitions = 1000;
  const std::unique_ptr<Rival> memory = make_legendre_memory(sensor, 8);
  EXPECT_EQ(memory->bits_per_pixel(), 8 * 15) << "2000 detections of at most 7, and a sign";
  EXPECT_EQ(memory->hardware().table_bits, 7 * 4 * 512);
  std::vector<Detection> all;
  for (std::uint32_t a = 0; a < 1000; ++a) {
    all.push_back({a, 0});
    all.push_back({a, 0});
  }
  const std::vector<std::int16_t> weights = legendre_weights(10, 8, 4);
  const RivalWords words = read_one_frame(*memory, all);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(words[k], 2000 * weights[k]) << k;
  }
}

// 13 bits and a sign hold 8191.
TEST(LegendreMemory, HasTheBitsThatAFrameNeeds) {
  SensorModel sensor;
  sensor.slots = 1;
  sensor.acquisitions = 1170;  // 7 x 1170 = 8190
  EXPECT_EQ(make_legendre_memory(sensor, 8)->bits_per_pixel(), 8 * 14);
  sensor.acquisitions = 1171;  // 8197
  EXPECT_EQ(make_legendre_memory(sensor, 8)->bits_per_pixel(), 8 * 15);
}

TEST(LegendreMemory, FindsANoiseFreePulse) {
  SensorModel sensor;
  sensor.acquisitions = 20000;
  for (const int order : {8, 12, 16, 32}) {
    const std::unique_ptr<Rival> memory = make_legendre_memory(sensor, order);
    for (const double centre : {90.0, 317.0, 512.5, 800.0, 940.0}) {
      for (const int floor : {0, 2}) {
        const RivalWords words = read_one_frame(*memory, noise_free_pulse(sensor, centre, 2000.0, floor));
        EXPECT_NEAR(memory->decode(words).position, centre, 1.0) << order << " " << floor;
        const std::vector<double> evidence = memory->evidence(words);
        EXPECT_NEAR(static_cast<double>(std::ranges::max_element(evidence) - evidence.begin()), centre, 1.5)
            << order << " " << floor;
      }
    }
  }
}

}  // namespace
}  // namespace dtof
