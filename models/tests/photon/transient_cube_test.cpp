// SPDX-License-Identifier: Apache-2.0
// Photons of transient cubes compared with closed forms, and with depth maps and panes of the same light.
#include "dtof/photon/transient_cube.hpp"

#include <memory>
#include <numeric>

#include "dtof/core/pulse_response.hpp"
#include "tests/photon/surroundings_fixture.hpp"

namespace dtof {
namespace {

constexpr double kPicosecond = 1e-12;

double travel_s(double distance_m) { return 2.0 * distance_m / kSpeedOfLight; }

class TransientCubeTest : public SurroundingsTest {
 protected:
  /// Every pixel with the same light: events in a bin that begins at each time.
  [[nodiscard]] PhotonSource cube_source(const std::vector<double>& values, const TransientScale& scale,
                                         double reflectivity = 1.0) const {
    TargetMap map(kColumns, kRows, {.depth_m = 2.0, .reflectivity = reflectivity});
    auto cube = std::make_shared<TransientCube>(kColumns, kRows, scale);
    for (int column = 0; column < kColumns; ++column) {
      for (int row = 0; row < kRows; ++row) {
        cube->set(column, row, values);
      }
    }
    map.set_cube(std::move(cube));
    return {sensor_, std::move(map), 14.0, test_seed()};
  }
  /// A bin of a picosecond around the time of a distance.
  [[nodiscard]] PhotonSource bin_at(double distance_m, double events) const {
    return cube_source({0.0, events, 0.0},
                       {.bin_width_s = kPicosecond, .start_s = travel_s(distance_m) - 1.5 * kPicosecond});
  }
};

TEST_F(TransientCubeTest, OneBinIsTheDepthMapAtItsDistance) {
  const std::vector<double> expected = means(kBackground, {{0.3 / 4.0, bins(2.0)}});
  EXPECT_GT(poisson_chi_square_p(counts(source(2.0)), expected), kErrorRate);
  EXPECT_GT(poisson_chi_square_p(counts(bin_at(2.0, 0.3 / 4.0)), expected), kErrorRate);
  EXPECT_LT(poisson_chi_square_p(counts(bin_at(2.02, 0.3 / 4.0)), expected), kErrorRate);
  EXPECT_LT(poisson_chi_square_p(counts(bin_at(2.0, 0.33 / 4.0)), expected), kErrorRate);
}

TEST_F(TransientCubeTest, OneBinFillsTheSlotsAsTheDepthMapDoes) {
  sensor_.slots = 1;
  const PhotonSource depth = source(0.7);
  const std::vector<double> expected = expected_detections(sensor_, depth.rates(0, 0));
  const double events = depth.rates(0, 0).signal;
  EXPECT_GT(events, 0.5);
  EXPECT_GT(chi_square_p(counts(depth), expected, kTrials), kErrorRate);
  EXPECT_GT(chi_square_p(counts(bin_at(0.7, events)), expected, kTrials), kErrorRate);
  EXPECT_LT(chi_square_p(counts(bin_at(0.7, 1.1 * events)), expected, kTrials), kErrorRate);
}

TEST_F(TransientCubeTest, ManyEventsInAPulseAreSorted) {
  make_dark();
  sensor_.acquisitions = 300;
  const auto drawn = static_cast<double>(detections(bin_at(2.0, 40.0)).size());
  EXPECT_EQ(drawn, 300.0 * kColumns * kRows * sensor_.slots);
}

TEST_F(TransientCubeTest, AWideBinIsUniform) {
  // 4 ns, as wide as two pulses: a sum of thin slices.
  constexpr int kSlices = 400;
  const double width = 4e-9;
  std::vector<std::pair<double, double>> slices;
  for (int i = 0; i < kSlices; ++i) {
    const double time = 10e-9 + (i + 0.5) / kSlices * width + sensor_.pulse_fwhm_s;
    slices.emplace_back(0.1 / kSlices, time / sensor_.time_resolution_s());
  }
  const std::vector<double> expected = means(kBackground, slices);
  const TransientScale scale{.bin_width_s = width, .start_s = 10e-9 - width, .events_per_unit = 0.05};
  EXPECT_GT(poisson_chi_square_p(counts(cube_source({0.0, 2.0}, scale)), expected), kErrorRate);
  EXPECT_LT(poisson_chi_square_p(counts(cube_source({1.0, 1.0}, scale)), expected), kErrorRate);
}

TEST_F(TransientCubeTest, EachBinHasItsShare) {
  // A decaying tail, as of light between walls.
  std::vector<double> tail(60);
  std::vector<std::pair<double, double>> returns;
  const TransientScale scale{.bin_width_s = 0.2e-9, .start_s = 8e-9};
  for (std::size_t i = 0; i < tail.size(); ++i) {
    tail[i] = i % 7 == 3 ? 0.0 : 0.02 * std::exp(-0.05 * static_cast<double>(i));
    constexpr int kSlices = 4;
    for (int k = 0; k < kSlices; ++k) {
      const double time = scale.start_s + (static_cast<double>(i) + (k + 0.5) / kSlices) * scale.bin_width_s;
      returns.emplace_back(tail[i] / kSlices, (time + sensor_.pulse_fwhm_s) / sensor_.time_resolution_s());
    }
  }
  EXPECT_GT(poisson_chi_square_p(counts(cube_source(tail, scale)), means(kBackground, returns)), kErrorRate);
  tail[40] *= 3.0;
  EXPECT_LT(poisson_chi_square_p(counts(cube_source(tail, scale)), means(kBackground, returns)), kErrorRate);
}

TEST_F(TransientCubeTest, TwoReturnsAreAPaneBeforeATarget) {
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.05, .transmittance = 0.8};
  const std::vector<std::uint64_t> pane = counts(source(2.0));
  around_.pane = {};
  const double step = 0.5 * (travel_s(2.0) - travel_s(1.0)) / 2000.0;
  std::vector<double> values(4001, 0.0);
  values.front() = 0.3 * 0.05;
  values.back() = 0.3 / 4.0 * 0.64;
  const TransientScale scale{.bin_width_s = step, .start_s = travel_s(1.0) - 0.5 * step};
  // The pane dims the sunlight, too.
  const std::vector<std::uint64_t> cube = counts(cube_source(values, scale, 0.8));
  const std::vector<double> expected =
      means(0.15 * 0.8 + 4.5e-4, {{0.3 / 4.0 * 0.64, bins(2.0)}, {0.3 * 0.05, bins(1.0)}});
  EXPECT_GT(poisson_chi_square_p(pane, expected), kErrorRate);
  EXPECT_GT(poisson_chi_square_p(cube, expected), kErrorRate);
  std::swap(values.front(), values.back());
  EXPECT_LT(poisson_chi_square_p(counts(cube_source(values, scale, 0.8)), expected), kErrorRate);
}

TEST_F(TransientCubeTest, AMeasuredPulseWidensItsBins) {
  make_dark();
  sensor_.pulse_response =
      std::make_shared<const PulseResponse>(std::vector<double>{4.0, 3.0, 2.0, 1.0, 1.0}, 0.7e-9);
  const auto response = sensor_.pulse_response_bins();
  std::vector<double> expected(kCodes);
  for (std::size_t code = 0; code < kCodes; ++code) {
    const double from = static_cast<double>(code) - bins(2.0);
    expected[code] = kTrials * 0.1 * (response->share_before(from + 1.0) - response->share_before(from));
  }
  EXPECT_GT(poisson_chi_square_p(counts(bin_at(2.0, 0.1)), expected), kErrorRate);
  sensor_.pulse_response = nullptr;
  EXPECT_LT(poisson_chi_square_p(counts(bin_at(2.0, 0.1)), expected), kErrorRate);
}

TEST_F(TransientCubeTest, SurroundingsOfTheSensorRemain) {
  around_.cover_glass = {.events = 0.08, .distance_m = 0.05};
  around_.settling.silent_share = 0.5;
  EXPECT_GT(poisson_chi_square_p(counts(bin_at(1.4, 0.1)),
                                 means(kBackground, {{0.05, bins(1.4)}, {0.04, bins(0.05)}})),
            kErrorRate);
  around_.settling.silent_share = 0.0;
  around_.skew = {.column_s = 2e-9, .pattern = SkewPattern::kAlternating};
  const double skew = 2e-9 / sensor_.time_resolution_s();
  EXPECT_GT(poisson_chi_square_p(counts(bin_at(2.0, 0.1)), means(kBackground, {{0.05, bins(2.0) + skew},
                                                                               {0.05, bins(2.0) - skew},
                                                                               {0.04, bins(0.05) + skew},
                                                                               {0.04, bins(0.05) - skew}})),
            kErrorRate);
}

TEST_F(TransientCubeTest, DarkPixelsHaveTheBackgroundAlone) {
  EXPECT_GT(
      poisson_chi_square_p(counts(cube_source({0.0, 0.0}, {.bin_width_s = 1e-9})), means(kBackground, {})),
      kErrorRate);
  sensor_.defects.dead_share = 1.0;
  EXPECT_TRUE(detections(bin_at(2.0, 0.1)).empty());
}

TEST_F(TransientCubeTest, RefusesWhatNeedsDistances) {
  const auto message = [this] {
    try {
      (void)bin_at(2.0, 0.1);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(), "");
  around_.fog.extinction_per_m = 0.1;
  EXPECT_THAT(message(), HasSubstr("fog, pane or radial motion cannot see a transient cube"));
  around_ = {};
  around_.pane = {.distance_m = 1.0, .reflectivity = 0.1};
  EXPECT_THAT(message(), HasSubstr("fog, pane or radial motion"));
  around_ = {};
  around_.motion.velocity_m_per_s = 1.0;
  EXPECT_THAT(message(), HasSubstr("fog, pane or radial motion"));
  around_ = {};
  EXPECT_THROW(FastPhotonSource(bin_at(2.0, 0.1)), InputError);
  EXPECT_THROW(MeanPhotonSource(bin_at(2.0, 0.1)), InputError);
  EXPECT_FALSE(FastPhotonSource::supports(bin_at(2.0, 0.1)));
  EXPECT_TRUE(FastPhotonSource::supports(source(2.0)));
  EXPECT_THROW((void)bin_at(2.0, 1e6), InputError);
}

/// One pixel with this light, in bins of 1 ns from the laser's shot.
TransientCube pixel(const std::vector<double>& values) {
  TransientCube cube(1, 1, {.bin_width_s = 1e-9});
  cube.set(0, 0, values);
  return cube;
}

constexpr double kMetresPerNs = 0.5 * kSpeedOfLight * 1e-9;

TEST(TransientReturns, TheStrongestReturnIsTheWindowWithTheMostEvents) {
  const TransientCube cube = pixel({0, 1, 0, 0, 0, 2, 6, 2, 0, 0, 0.5});
  const TransientReturn strongest = cube.strongest_return(0, 0, 3e-9);
  EXPECT_NEAR(strongest.distance_m, 6.5 * kMetresPerNs, 1e-9);
  EXPECT_DOUBLE_EQ(strongest.events, 10.0);
  // A window of one bin has the highest bin.
  EXPECT_DOUBLE_EQ(cube.strongest_return(0, 0, 0.0).events, 6.0);
  // The earlier one of two equal returns.
  EXPECT_NEAR(pixel({0, 3, 0, 0, 3}).strongest_return(0, 0, 1e-9).distance_m, 1.5 * kMetresPerNs, 1e-9);
  EXPECT_EQ(pixel({0, 0, 0}).strongest_return(0, 0, 1e-9).distance_m, 0.0);
}

TEST(TransientReturns, TheFirstReturnHasAQuarterOfTheStrongest) {
  const TransientCube cube = pixel({0, 1, 2, 1, 0, 0, 0, 2, 6, 2});
  EXPECT_NEAR(cube.first_return(0, 0, 3e-9).distance_m, 2.5 * kMetresPerNs, 1e-9);
  // Less is stray light.
  const TransientCube stray = pixel({0, 1, 1, 0, 0, 0, 0, 2, 6, 2});
  EXPECT_NEAR(stray.first_return(0, 0, 3e-9).distance_m, 8.5 * kMetresPerNs, 1e-9);
  EXPECT_EQ(pixel({0, 0}).first_return(0, 0, 1e-9).events, 0.0);
}

TEST(TransientLight, EventsBeforeAndQuantileAreInverse) {
  const TransientCube cube = pixel({0, 0, 2, 0, 1, 5});
  const TransientLight light = cube.light(0, 0);
  EXPECT_DOUBLE_EQ(light.events(), 8.0);
  EXPECT_DOUBLE_EQ(light.events_before(2e-9), 0.0);
  EXPECT_DOUBLE_EQ(light.events_before(2.5e-9), 1.0);
  EXPECT_DOUBLE_EQ(light.events_before(3.7e-9), 2.0);
  EXPECT_DOUBLE_EQ(light.events_before(1.0), 8.0);
  for (double share = 0.0; share < 1.0; share += 0.01) {
    EXPECT_NEAR(light.events_before(light.quantile(share)), 8.0 * share, 1e-9) << share;
  }
  EXPECT_NEAR(light.quantile(std::nextafter(1.0, 0.0)), 6e-9, 1e-21);
}

TEST(TransientCube, RefusesIllegalNumbers) {
  TransientCube cube(2, 1, {.bin_width_s = 1e-9});
  for (const double wrong : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(cube.set(1, 0, std::vector<double>{0.0, wrong}), InputError) << wrong;
  }
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(TransientCube(1, 1, {.bin_width_s = wrong}), InputError) << wrong;
    EXPECT_THROW(TransientCube(1, 1, {.bin_width_s = 1e-9, .events_per_unit = wrong}), InputError) << wrong;
  }
  EXPECT_THROW(TransientCube(1, 1, {.bin_width_s = 1e-9, .start_s = std::nan("")}), InputError);
  EXPECT_THROW(TransientCube(0, 1, {.bin_width_s = 1e-9}), InputError);
  TargetMap map(1, 1);
  EXPECT_THROW(map.set_cube(std::make_shared<TransientCube>(cube)), InputError);
}

}  // namespace
}  // namespace dtof
