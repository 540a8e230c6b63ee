// SPDX-License-Identifier: Apache-2.0
// Firing offsets, moving targets, a laser that settles and skew.
#include "tests/photon/surroundings_fixture.hpp"

namespace dtof {
namespace {

TEST(FiringOffsets, AreTheRegistersLowBits) {
  EXPECT_TRUE(FiringOffsets{}.delays(100).empty());
  const FiringOffsets offsets{.bits = 5, .step_s = 2.0, .seed = 0xACE1};
  const std::vector<double> delays = offsets.delays(65535);
  EXPECT_EQ(delays, offsets.delays(65535));
  // The register bit by bit: x^16 + x^14 + x^13 + x^11 + 1 is primitive, and 16 steps are no divisor of its
  // period, so that 65,535 pulses have every state but 0 once.
  std::vector<bool> bits(16);
  for (unsigned i = 0; i < 16; ++i) {
    bits[i] = ((0xACE1U >> i) & 1U) != 0;
  }
  std::vector<int> seen(32);
  for (const double delay : delays) {
    int low = 0;
    for (unsigned i = 0; i < 5; ++i) {
      low |= static_cast<int>(bits[i]) << i;
    }
    ASSERT_EQ(delay, 2.0 * low);
    ++seen[static_cast<std::size_t>(low)];
    for (int step = 0; step < 16; ++step) {
      const bool feedback = (bits[0] != bits[2]) != (bits[3] != bits[5]);
      bits.erase(bits.begin());
      bits.push_back(feedback);
    }
  }
  EXPECT_EQ(seen[0], 2047);
  EXPECT_EQ(std::ranges::count(seen, 2048), 31);
}

TEST_F(SurroundingsTest, MovingTargetMovesAndFades) {
  make_dark();
  around_.motion.velocity_m_per_s = 20.0;
  const double travel = 20.0 * 10e-6;
  const auto distance = [&](double acquisition) {
    return 2.0 + travel * (acquisition - 0.5 * (kAcquisitions - 1));
  };
  const std::vector<Detection> all = detections(source(2.0));
  EXPECT_GT(gaussian_p(all, [&](std::uint32_t acquisition) { return bins(distance(acquisition)); }),
            kErrorRate);
  std::vector<std::uint64_t> tenths(10);
  std::vector<double> expected(10);
  for (const Detection& detection : all) {
    ++tenths[detection.acquisition / (kAcquisitions / 10)];
  }
  for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
    expected[acquisition / (kAcquisitions / 10)] +=
        0.3 / distance(acquisition) / distance(acquisition) * kColumns * kRows;
  }
  EXPECT_GT(poisson_chi_square_p(tenths, expected), kErrorRate);
  around_.motion.velocity_m_per_s = -20.0;
  EXPECT_LT(gaussian_p(detections(source(2.0)),
                       [&](std::uint32_t acquisition) { return bins(distance(acquisition)); }),
            kErrorRate);
}

TEST_F(SurroundingsTest, MovingTargetInFogFadesByBoth) {
  make_dark();
  sensor_.signal_events_1m = 3.0;
  around_.motion.velocity_m_per_s = -30.0;
  around_.fog = {.extinction_per_m = 1.0, .lidar_ratio_sr = 1e9};  // nothing returns
  std::vector<std::uint64_t> tenths(10);
  std::vector<double> expected(10);
  for (const Detection& detection : detections(source(1.5))) {
    ++tenths[detection.acquisition / (kAcquisitions / 10)];
  }
  for (std::uint32_t acquisition = 0; acquisition < kAcquisitions; ++acquisition) {
    const double distance = 1.5 - 30.0 * 10e-6 * (acquisition - 0.5 * (kAcquisitions - 1));
    expected[acquisition / (kAcquisitions / 10)] +=
        3.0 / distance / distance * std::exp(-2.0 * distance) * kColumns * kRows;
  }
  EXPECT_GT(poisson_chi_square_p(tenths, expected), kErrorRate);
}

TEST_F(SurroundingsTest, LaserSettlesInPowerAndDelay) {
  make_dark();
  around_.settling = {
      .silent_share = 0.2, .power_drop = 0.8, .delay_s = 1e-9, .time_share = 0.1, .power_drift = -0.3};
  around_.cover_glass = {.events = 0.0};
  const std::vector<Detection> all = detections(source(2.0));
  std::vector<std::uint64_t> parts(30);
  std::vector<double> expected(30);
  for (const Detection& detection : all) {
    ASSERT_GE(detection.acquisition, 600U);
    ++parts[detection.acquisition / 100];
  }
  const auto share = [](std::uint32_t acquisition) { return std::exp(-(acquisition - 600.0) / 300.0); };
  for (std::uint32_t acquisition = 600; acquisition < kAcquisitions; ++acquisition) {
    const double drift = 1.0 - 0.3 * ((acquisition + 0.5) / kAcquisitions - 0.5);
    expected[acquisition / 100] += 0.075 * (1.0 - 0.8 * share(acquisition)) * drift * kColumns * kRows;
  }
  EXPECT_GT(poisson_chi_square_p(parts, expected), kErrorRate);
  EXPECT_GT(gaussian_p(all,
                       [&](std::uint32_t acquisition) {
                         return bins(2.0) + 1e-9 * share(acquisition) / sensor_.time_resolution_s();
                       }),
            kErrorRate);
}

TEST_F(SurroundingsTest, EveryReturnOfTheOwnLaserSettles) {
  make_dark();
  around_.settling.silent_share = 0.5;
  around_.cover_glass = {.events = 0.1, .distance_m = 0.1};
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.1, .transmittance = 1.0};
  around_.fog = {.extinction_per_m = 0.2};
  const std::vector<Detection> own = detections(source(2.0));
  EXPECT_GT(own.size(), 1000U);
  EXPECT_TRUE(
      std::ranges::all_of(own, [](const Detection& d) { return d.acquisition >= kAcquisitions / 2; }));
  // The other laser does not.
  around_.other_laser = {.events = 0.1, .first_arrival_s = 30e-9};
  EXPECT_TRUE(std::ranges::any_of(detections(source(2.0)),
                                  [](const Detection& d) { return d.acquisition < kAcquisitions / 2; }));
}

TEST_F(SurroundingsTest, SkewMovesReturnsAndNotTheSun) {
  around_.skew = {.column_s = 0.4e-9, .pattern = SkewPattern::kAlternating};
  const double skew = 0.4e-9 / sensor_.time_resolution_s();
  EXPECT_GT(poisson_chi_square_p(counts(source(2.0)), means(kBackground, {{0.0375, bins(2.0) + skew},
                                                                          {0.0375, bins(2.0) - skew}})),
            kErrorRate);
  EXPECT_LT(poisson_chi_square_p(counts(source(2.0)), means(kBackground, {{0.075, bins(2.0)}})), kErrorRate);
  around_.cover_glass = {.events = 0.1, .distance_m = 1.0};
  EXPECT_GT(poisson_chi_square_p(counts(source(0.0)),
                                 means(kBackground, {{0.05, bins(1.0) + skew}, {0.05, bins(1.0) - skew}})),
            kErrorRate);
}

TEST_F(SurroundingsTest, SkewDelaysEveryReturnOfItsColumn) {
  make_dark();
  around_.skew = {.column_s = 0.4e-9, .pattern = SkewPattern::kAlternating};
  const double skew = 0.4e-9 / sensor_.time_resolution_s();
  const auto even_column = [&](double depth_m, double centre) {
    std::vector<Detection> own;
    const ColumnStream stream = source(depth_m).column(2);
    for (int row = 0; row < stream.rows(); ++row) {
      own.insert(own.end(), stream.row(row).begin(), stream.row(row).end());
    }
    EXPECT_GT(own.size(), 300U);
    return gaussian_p(own, [centre](std::uint32_t) { return centre; });
  };
  EXPECT_GT(even_column(2.0, bins(2.0) + skew), kErrorRate);
  EXPECT_LT(even_column(2.0, bins(2.0) - skew), kErrorRate);
  around_.motion.velocity_m_per_s = 1e-9;
  EXPECT_GT(even_column(2.0, bins(2.0) + skew), kErrorRate);
  around_.motion = {};
  around_.cover_glass = {.events = 0.1, .distance_m = 1.0};
  EXPECT_GT(even_column(0.0, bins(1.0) + skew), kErrorRate);
  around_.cover_glass = {};
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.3, .transmittance = 0.5};
  EXPECT_GT(even_column(0.0, bins(1.0) + skew), kErrorRate);
  around_.pane = {};
  around_.other_laser = {.events = 0.1, .first_arrival_s = 20e-9};
  EXPECT_GT(even_column(0.0, 20e-9 / sensor_.time_resolution_s() + skew), kErrorRate);
  around_.other_laser = {};
  // Fog that ends a millimetre behind its begin.
  around_.fog = {.extinction_per_m = 1.0, .lidar_ratio_sr = 0.002, .overlap_m = 1.999};
  sensor_.signal_events_1m = 0.2;
  EXPECT_GT(even_column(2.0, bins(2.0) + skew), kErrorRate);
}

TEST(TimingSkew, PatternsOfColumnsAndPixels) {
  TimingSkew skew{.column_s = 3.0, .pattern = SkewPattern::kAlternating};
  EXPECT_EQ(skew.of_pixel(4, 9, 11), 3.0);
  EXPECT_EQ(skew.of_pixel(5, 2, 11), -3.0);
  skew.pattern = SkewPattern::kRamp;
  EXPECT_EQ(skew.of_pixel(0, 0, 11), -3.0);
  EXPECT_EQ(skew.of_pixel(5, 0, 11), 0.0);
  EXPECT_EQ(skew.of_pixel(10, 0, 11), 3.0);
  EXPECT_EQ(skew.of_pixel(0, 0, 1), 0.0);
  skew.pattern = SkewPattern::kRandom;
  std::vector<double> columns;
  std::vector<double> pixels;
  for (int i = 0; i < 2000; ++i) {
    columns.push_back((skew.of_pixel(i, 0, 2000) / 3.0 + 1.0) / 2.0);
    EXPECT_EQ(skew.of_pixel(i, 0, 2000), skew.of_pixel(i, 77, 2000));
    const TimingSkew own{.pixel_s = 2.0, .seed = 9};
    pixels.push_back((own.of_pixel(i % 40, i / 40, 40) / 2.0 + 1.0) / 2.0);
  }
  EXPECT_GT(kolmogorov_smirnov_p(columns), kErrorRate);
  EXPECT_GT(kolmogorov_smirnov_p(pixels), kErrorRate);
  EXPECT_EQ(std::set<double>(pixels.begin(), pixels.end()).size(), pixels.size());
  EXPECT_TRUE(TimingSkew{}.none());
}

}  // namespace
}  // namespace dtof
