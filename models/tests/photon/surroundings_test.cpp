// SPDX-License-Identifier: Apache-2.0
// What surrounds a sensor against closed forms or sums of the test's own. Seeds are fixed (DTOF_TEST_SEED
// changes them); a right model fails one test in a million (kErrorRate).
#include "dtof/photon/surroundings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/physical_constants.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;

constexpr std::uint32_t kAcquisitions = 3000;
constexpr int kColumns = 4;
constexpr int kRows = 50;
constexpr std::size_t kCodes = 1024;
constexpr double kTrials = 1.0 * kAcquisitions * kColumns * kRows;

class SurroundingsTest : public ::testing::Test {
 protected:
  SurroundingsTest() {
    sensor_.acquisitions = kAcquisitions;
    sensor_.slots = 16;
    sensor_.pulse_period_s = 10e-6;
  }

  [[nodiscard]] PhotonSource source(double depth_m, double klux = 14.0) const {
    return {sensor_, TargetMap(kColumns, kRows, {.depth_m = depth_m, .reflectivity = 1.0}), klux,
            test_seed()};
  }
  /// Only the events of what the test is about.
  void make_dark() {
    sensor_.dark_count_rate_hz = 0.0;
    sensor_.background_events_per_klux = 0.0;
  }

  [[nodiscard]] static std::vector<Detection> detections(const PhotonSource& source) {
    std::vector<Detection> all;
    for (int column = 0; column < source.columns(); ++column) {
      const ColumnStream stream = source.column(column);
      for (int row = 0; row < stream.rows(); ++row) {
        const auto own = stream.row(row);
        EXPECT_TRUE(std::ranges::is_sorted(
            own, {}, [](const Detection& d) { return std::pair(d.acquisition, d.timestamp); }));
        all.insert(all.end(), own.begin(), own.end());
      }
    }
    return all;
  }
  [[nodiscard]] static std::vector<std::uint64_t> counts(const PhotonSource& source) {
    std::vector<std::uint64_t> codes(kCodes);
    for (const Detection& detection : detections(source)) {
      ++codes.at(detection.timestamp);
    }
    return codes;
  }
  [[nodiscard]] double bins(double distance_m, double fwhm_s = 2e-9) const {
    return (2.0 * distance_m / kSpeedOfLight + fwhm_s) / sensor_.time_resolution_s();
  }
  [[nodiscard]] double sigma() const { return 2e-9 / 2.3548200450309493 / sensor_.time_resolution_s(); }
  /// Mean events of each code: flat background and Gaussian returns of (events a pulse, centre in bins).
  [[nodiscard]] std::vector<double> means(double background,
                                          const std::vector<std::pair<double, double>>& returns) const {
    std::vector<double> sum(kCodes, background / kCodes);
    for (const auto& [events, centre] : returns) {
      const std::vector<double> own = bin_means(kCodes, 0.0, events, centre, sigma());
      for (std::size_t i = 0; i < kCodes; ++i) {
        sum[i] += own[i];
      }
    }
    for (double& mean : sum) {
      mean *= kTrials;
    }
    return sum;
  }
  /// p-value of the times being Gaussian around `centre` of their acquisition: half a bin is drawn anew.
  template <typename Centre>
  [[nodiscard]] double gaussian_p(const std::vector<Detection>& all, const Centre& centre) const {
    CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestControl), 5, 7);
    std::vector<double> shares;
    for (const Detection& detection : all) {
      // Within a bin the density is not flat, which is far below what the test resolves: bins are sigma / 19.
      const double time = detection.timestamp + random.uniform();
      shares.push_back(0.5 *
                       std::erfc(-(time - centre(detection.acquisition)) / sigma() / std::numbers::sqrt2));
    }
    return kolmogorov_smirnov_p(shares);
  }

  SensorModel sensor_;
  Surroundings& around_ = sensor_.surroundings;
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

constexpr double kBackground = 0.15 + 4.5e-4;

TEST_F(SurroundingsTest, CoverGlassIsAnEarlyReturnOfEveryPixel) {
  around_.cover_glass = {.events = 0.08, .distance_m = 0.05};
  const std::vector<double> expected = means(kBackground, {{0.3 / 4.0, bins(2.0)}, {0.08, bins(0.05)}});
  EXPECT_GT(poisson_chi_square_p(counts(source(2.0)), expected), kErrorRate);
  // Where there is no target, the glass still is.
  EXPECT_GT(poisson_chi_square_p(counts(source(0.0)), means(kBackground, {{0.08, bins(0.05)}})), kErrorRate);
  around_.cover_glass.events = 0.1;
  EXPECT_LT(poisson_chi_square_p(counts(source(2.0)), expected), kErrorRate);
}

TEST_F(SurroundingsTest, EarlyReturnsTakeTheSlots) {
  around_.cover_glass = {.events = 0.7, .distance_m = 0.05};
  sensor_.slots = 1;
  std::vector<double> first = means(kBackground, {{0.3 / 4.0, bins(2.0)}, {0.7, bins(0.05)}});
  double before = 0.0;
  for (double& mean : first) {
    const double events = mean / kTrials;
    mean = std::exp(-before) * -std::expm1(-events);
    before += events;
  }
  EXPECT_GT(chi_square_p(counts(source(2.0)), first, kTrials), kErrorRate);
}

/// Events of each code that a fog from `from` to `to` m returns, by a sum over thin layers.
std::vector<double> layers(const Fog& fog, double from, double to, double sigma,
                           const std::function<double(double)>& centre) {
  constexpr int kLayers = 4000;
  std::vector<double> sum(kCodes, 0.0);
  const double width = (to - from) / kLayers;
  for (int i = 0; i < kLayers; ++i) {
    const double r = from + (i + 0.5) * width;
    const double events = 0.3 * std::numbers::pi * fog.extinction_per_m / fog.lidar_ratio_sr *
                          std::exp(-2.0 * fog.extinction_per_m * r) / r / r * width;
    const std::vector<double> own = bin_means(kCodes, 0.0, events, centre(r), sigma);
    for (std::size_t code = 0; code < kCodes; ++code) {
      sum[code] += kTrials * own[code];
    }
  }
  return sum;
}

TEST_F(SurroundingsTest, FogReturnsAndAttenuates) {
  around_.fog = {.extinction_per_m = 0.25, .lidar_ratio_sr = 20.0, .overlap_m = 0.2};
  const auto centre = [this](double metres) { return bins(metres); };
  std::vector<double> expected = layers(around_.fog, 0.2, 3.0, sigma(), centre);
  const std::vector<double> rest = means(kBackground, {{0.3 / 9.0 * std::exp(-1.5), bins(3.0)}});
  for (std::size_t i = 0; i < kCodes; ++i) {
    expected[i] += rest[i];
  }
  EXPECT_GT(poisson_chi_square_p(counts(source(3.0)), expected), kErrorRate);
  around_.fog.extinction_per_m = 0.35;
  EXPECT_LT(poisson_chi_square_p(counts(source(3.0)), expected), kErrorRate);
}

TEST_F(SurroundingsTest, FogBeforeTheSkyReachesTheRangesEnd) {
  make_dark();
  around_.fog = {.extinction_per_m = 0.1, .lidar_ratio_sr = 18.8, .overlap_m = 0.1};
  const auto centre = [this](double metres) { return bins(metres); };
  EXPECT_GT(poisson_chi_square_p(counts(source(0.0)), layers(around_.fog, 0.1, 8.0, sigma(), centre)),
            kErrorRate);
}

TEST_F(SurroundingsTest, DenseFogReturnsAsManyEventsAsTheClosedForm) {
  make_dark();
  for (const double overlap : {0.1, 0.5}) {
    around_.fog = {.extinction_per_m = 2.0, .lidar_ratio_sr = 10.0, .overlap_m = overlap};
    const double expected = kTrials * fog_events(around_.fog, 0.3, std::numeric_limits<double>::infinity());
    const auto drawn = static_cast<double>(detections(source(0.0)).size());
    EXPECT_GT(normal_p(drawn - expected, std::sqrt(expected)), kErrorRate) << overlap;
    around_.fog.extinction_per_m = 1.8;
    EXPECT_LT(normal_p(static_cast<double>(detections(source(0.0)).size()) - expected, std::sqrt(expected)),
              kErrorRate);
  }
}

TEST_F(SurroundingsTest, FogEventsAreTheIntegralOfItsLayers) {
  for (const double extinction : {0.02, 0.3, 2.0}) {
    const Fog fog{.extinction_per_m = extinction, .lidar_ratio_sr = 30.0, .overlap_m = 0.15};
    // Simpson's rule over 1 / R.
    const auto density = [&](double near) { return std::exp(-2.0 * extinction / near); };
    constexpr int kSteps = 2000;
    const double low = 1.0 / 4.0;
    const double high = 1.0 / 0.15;
    double sum = density(low) + density(high);
    for (int i = 1; i < kSteps; ++i) {
      sum += (i % 2 == 1 ? 4.0 : 2.0) * density(low + (high - low) * i / kSteps);
    }
    const double integral = 0.3 * std::numbers::pi * extinction / 30.0 * sum * (high - low) / kSteps / 3.0;
    EXPECT_NEAR(fog_events(fog, 0.3, 4.0), integral, 1e-9 * integral);
    EXPECT_GT(fog_events(fog, 0.3, std::numeric_limits<double>::infinity()), integral);
  }
  EXPECT_EQ(fog_events({}, 0.3, 4.0), 0.0);
  EXPECT_EQ(fog_events({.extinction_per_m = 1.0}, 0.3, 0.1), 0.0);
}

TEST_F(SurroundingsTest, PaneReturnsBeforeWhatItDims) {
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.05, .transmittance = 0.8};
  EXPECT_GT(poisson_chi_square_p(
                counts(source(2.0)),
                means(0.15 * 0.8 + 4.5e-4, {{0.3 / 4.0 * 0.64, bins(2.0)}, {0.3 * 0.05, bins(1.0)}})),
            kErrorRate);
  // Before the sky it returns, too; behind a nearer target nobody sees it.
  EXPECT_GT(poisson_chi_square_p(counts(source(0.0)), means(0.15 * 0.8 + 4.5e-4, {{0.3 * 0.05, bins(1.0)}})),
            kErrorRate);
  EXPECT_GT(poisson_chi_square_p(counts(source(0.8)), means(kBackground, {{0.3 / 0.64, bins(0.8)}})),
            kErrorRate);
}

TEST_F(SurroundingsTest, PaneInFogIsDimmedAndDimsTheFogBehind) {
  make_dark();
  around_.fog = {.extinction_per_m = 0.3, .lidar_ratio_sr = 15.0, .overlap_m = 0.3};
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.05, .transmittance = 0.7};
  const auto centre = [this](double metres) { return bins(metres); };
  std::vector<double> expected = layers(around_.fog, 0.3, 1.0, sigma(), centre);
  const std::vector<double> behind = layers(around_.fog, 1.0, 2.0, sigma(), centre);
  const std::vector<double> rest =
      means(0.0, {{0.3 * 0.05 * std::exp(-0.6), bins(1.0)}, {0.3 / 4.0 * std::exp(-1.2) * 0.49, bins(2.0)}});
  for (std::size_t i = 0; i < kCodes; ++i) {
    expected[i] += 0.49 * behind[i] + rest[i];
  }
  EXPECT_GT(poisson_chi_square_p(counts(source(2.0)), expected), kErrorRate);
}

TEST_F(SurroundingsTest, OtherLaserOfTheSameRateStandsStill) {
  around_.other_laser = {.events = 0.1, .first_arrival_s = 20e-9};
  const double centre = 20e-9 / sensor_.time_resolution_s();
  EXPECT_GT(
      poisson_chi_square_p(counts(source(2.0)), means(kBackground, {{0.3 / 4.0, bins(2.0)}, {0.1, centre}})),
      kErrorRate);
  // One that began a hundred periods earlier is the same.
  around_.other_laser.first_arrival_s = 20e-9 - 100.0 * 10e-6;
  EXPECT_GT(
      poisson_chi_square_p(counts(source(2.0)), means(kBackground, {{0.3 / 4.0, bins(2.0)}, {0.1, centre}})),
      kErrorRate);
}

TEST_F(SurroundingsTest, OtherLaserDrifts) {
  make_dark();
  around_.other_laser = {.events = 0.5, .rate_offset = 6e-6, .first_arrival_s = 99e-9};
  const std::vector<Detection> all = detections(source(0.0));
  // 60 ps earlier from acquisition to acquisition: in the range of 45 ns from acquisition 900 to 1,650.
  const double per_acquisition = 10e-6 * 6e-6 / (1.0 + 6e-6) / sensor_.time_resolution_s();
  const auto centre = [&](std::uint32_t acquisition) {
    return 99e-9 / sensor_.time_resolution_s() - per_acquisition * acquisition;
  };
  std::vector<Detection> inside;
  for (const Detection& detection : all) {
    EXPECT_GT(detection.acquisition, 750U);
    EXPECT_LT(detection.acquisition, 1800U);
    if (detection.acquisition >= 1000 && detection.acquisition < 1500) {
      inside.push_back(detection);
    }
  }
  EXPECT_GT(gaussian_p(inside, centre), kErrorRate);
  EXPECT_GT(normal_p(static_cast<double>(inside.size()) - 0.5 * 500 * kColumns * kRows,
                     std::sqrt(0.5 * 500 * kColumns * kRows)),
            kErrorRate);
  around_.other_laser.rate_offset = 6.1e-6;
  EXPECT_LT(gaussian_p(detections(source(0.0)), centre), kErrorRate);
}

TEST_F(SurroundingsTest, OtherLaserMayHaveAnotherPulse) {
  make_dark();
  around_.other_laser = {.events = 0.2, .first_arrival_s = 20e-9, .pulse_fwhm_s = 5e-9};
  sensor_.jitter_fwhm_s = 2e-9;
  const double wide = pulse_sigma_s(std::hypot(5e-9, 2e-9)) / sensor_.time_resolution_s();
  std::vector<double> expected =
      bin_means(kCodes, 0.0, 0.2 * kTrials, 20e-9 / sensor_.time_resolution_s(), wide);
  EXPECT_GT(poisson_chi_square_p(counts(source(0.0)), expected), kErrorRate);
}

TEST_F(SurroundingsTest, FiringOffsetsMoveOnlyTheOtherLaser) {
  const std::vector<Detection> plain = detections(source(2.0));
  around_.firing_offsets = {.bits = 5, .step_s = 3e-9, .seed = 77};
  EXPECT_EQ(detections(source(2.0)), plain);
  around_.other_laser = {.events = 0.2, .first_arrival_s = 95e-9};
  const std::vector<double> offsets = around_.firing_offsets.delays(kAcquisitions);
  make_dark();
  const std::vector<Detection> all = detections(source(0.0));
  EXPECT_GT(all.size(), 1000U);
  std::vector<Detection> inside;
  for (const Detection& detection : all) {
    const double centre = 95e-9 - offsets[detection.acquisition];
    EXPECT_GT(centre, -12e-9);
    EXPECT_LT(centre, 57e-9);
    if (centre > 6e-9 && centre < 39e-9) {
      inside.push_back(detection);
    }
  }
  EXPECT_GT(gaussian_p(inside,
                       [&](std::uint32_t acquisition) {
                         return (95e-9 - offsets[acquisition]) / sensor_.time_resolution_s();
                       }),
            kErrorRate);
}

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

TEST_F(SurroundingsTest, WhatIsOffLeavesThePhotonsAlone) {
  const std::vector<Detection> plain = detections(source(1.0));
  around_.cover_glass.distance_m = 0.5;
  around_.fog.overlap_m = 0.7;
  around_.pane.reflectivity = 0.5;
  around_.other_laser.first_arrival_s = 1e-9;
  around_.settling.time_share = 0.5;
  around_.skew.seed = 8;
  EXPECT_TRUE(around_.none());
  EXPECT_EQ(detections(source(1.0)), plain);
  EXPECT_TRUE(FastPhotonSource::supports(sensor_));
}

TEST_F(SurroundingsTest, DeadPixelsSeeNothing) {
  sensor_.defects.dead_share = 1.0;
  around_.cover_glass.events = 1.0;
  around_.other_laser.events = 1.0;
  around_.motion.velocity_m_per_s = 1.0;
  EXPECT_TRUE(detections(source(1.0)).empty());
}

TEST_F(SurroundingsTest, GateDeadTimeAndBinningSeeTheReturns) {
  make_dark();
  around_.cover_glass = {.events = 0.5, .distance_m = 0.3};
  sensor_.time_gate = TimeGate{10e-9, 45e-9};
  EXPECT_GT(poisson_chi_square_p(counts(source(3.0)), means(0.0, {{0.3 / 9.0, bins(3.0)}})), kErrorRate);
  sensor_.time_gate.reset();
  // Longer than the range: one event an acquisition.
  sensor_.dead_time_s = 60e-9;
  const double some = -std::expm1(-0.5 - 0.3 / 9.0);
  EXPECT_GT(binomial_p(static_cast<double>(detections(source(3.0)).size()), kTrials, some), kErrorRate);
  sensor_.dead_time_s = 0.0;
  sensor_.binning = 2;
  const double four = 4.0 * (0.5 + 0.3 / 9.0) * kTrials;
  // Four pixels of a block have one stream.
  EXPECT_GT(normal_p(static_cast<double>(detections(source(3.0)).size()) - four, std::sqrt(4.0 * four)),
            kErrorRate);
}

TEST_F(SurroundingsTest, MeasuredPulseIsThatOfEveryOwnReturn) {
  make_dark();
  sensor_.pulse_response = std::make_shared<const PulseResponse>(std::vector<double>{1.0}, 1e-9);
  around_.cover_glass = {.events = 0.5, .distance_m = 1.0};
  const double half = 0.5e-9 / sensor_.time_resolution_s();
  for (const Detection& detection : detections(source(0.0))) {
    ASSERT_GE(detection.timestamp + 1.0, bins(1.0) - half);
    ASSERT_LE(detection.timestamp, bins(1.0) + half);
  }
}

TEST_F(SurroundingsTest, ModelsWithoutSurroundingsRefuse) {
  around_.cover_glass.events = 0.1;
  EXPECT_FALSE(FastPhotonSource::supports(sensor_));
  EXPECT_THROW(FastPhotonSource{source(1.0)}, InputError);
  EXPECT_THROW(MeanPhotonSource{source(1.0)}, InputError);
  EXPECT_THROW((void)expected_detections(sensor_, {}), InputError);
  EXPECT_TRUE(sensor_.as_calibrated().surroundings.none());
}

TEST_F(SurroundingsTest, PulsesFollowEachOtherThirtyFramesASecond) {
  sensor_.pulse_period_s = 0.0;
  sensor_.acquisitions = 33'333;
  EXPECT_NEAR(sensor_.pulse_period(), 1e-6, 1e-10);
  sensor_.pulse_period_s = 4e-6;
  EXPECT_EQ(sensor_.pulse_period(), 4e-6);
}

TEST_F(SurroundingsTest, RefusesWhatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::function<void(Surroundings&)>, const char*>> cases = {
      {[](Surroundings& s) { s.cover_glass.events = -1.0; }, "cover glass"},
      {[nan](Surroundings& s) { s.cover_glass.distance_m = nan; }, "cover glass"},
      {[](Surroundings& s) { s.fog.extinction_per_m = -0.1; }, "extinction"},
      {[](Surroundings& s) { s.fog.lidar_ratio_sr = 0.0; }, "lidar ratio"},
      {[](Surroundings& s) { s.fog.overlap_m = 0.0; }, "overlap"},
      {[](Surroundings& s) { s.pane.distance_m = -1.0; }, "pane"},
      {[](Surroundings& s) { s.pane.reflectivity = -1.0; }, "pane"},
      {[](Surroundings& s) { s.pane.transmittance = 1.1; }, "transmittance"},
      {[](Surroundings& s) { s.other_laser.events = -1.0; }, "other laser"},
      {[](Surroundings& s) { s.other_laser.rate_offset = -1.0; }, "rate offset"},
      {[&](Surroundings& s) { s.other_laser.first_arrival_s = nan; }, "first arrival"},
      {[](Surroundings& s) { s.other_laser.pulse_fwhm_s = -1.0; }, "FWHM"},
      {[&](Surroundings& s) { s.motion.velocity_m_per_s = nan; }, "velocity"},
      {[](Surroundings& s) { s.settling.silent_share = 1.1; }, "silent"},
      {[](Surroundings& s) { s.settling.power_drop = 1.1; }, "power drop"},
      {[](Surroundings& s) { s.settling.delay_s = 1e-9; }, "time constant"},
      {[](Surroundings& s) { s.settling.time_share = -1.0; }, "time constant"},
      {[](Surroundings& s) { s.settling.power_drift = 2.5; }, "drift"},
      {[](Surroundings& s) { s.skew.column_s = -1e-9; }, "skew"},
      {[](Surroundings& s) { s.skew.pixel_s = -1e-9; }, "skew"},
      {[](Surroundings& s) { s.firing_offsets.bits = 13; }, "bits"},
      {[](Surroundings& s) { s.firing_offsets.step_s = -1.0; }, "step"},
      {[](Surroundings& s) { s.firing_offsets.seed = 0; }, "seed"}};
  for (const auto& [change, word] : cases) {
    Surroundings around;
    change(around);
    try {
      around.validate();
      ADD_FAILURE() << "accepted: " << word;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(word));
    }
  }
  around_.motion.velocity_m_per_s = 100.0;  // 1.5 m to each side
  EXPECT_THROW(source(1.4), InputError);
  EXPECT_NO_THROW(source(1.6));
  around_ = {};
  around_.other_laser.events = 0.1;
  sensor_.pulse_period_s = 40e-9;
  EXPECT_THROW(source(1.0), InputError);
  sensor_.pulse_period_s = 130e-9;
  EXPECT_NO_THROW(source(1.0));
  around_.firing_offsets = {.bits = 5, .step_s = 3e-9};
  EXPECT_THROW(source(1.0), InputError);
  around_ = {};
  around_.cover_glass.events = 1e6;
  EXPECT_THROW(source(1.0), InputError);
}

}  // namespace
}  // namespace dtof
