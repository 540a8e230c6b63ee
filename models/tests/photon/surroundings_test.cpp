// SPDX-License-Identifier: Apache-2.0
// Cover glass, fog, panes and another laser; what is off, refused or combined.
#include "tests/photon/surroundings_fixture.hpp"

namespace dtof {
namespace {

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
  EXPECT_THROW((void)source(1.4), InputError);
  EXPECT_NO_THROW((void)source(1.6));
  around_ = {};
  around_.other_laser.events = 0.1;
  sensor_.pulse_period_s = 40e-9;
  EXPECT_THROW((void)source(1.0), InputError);
  sensor_.pulse_period_s = 130e-9;
  EXPECT_NO_THROW((void)source(1.0));
  around_.firing_offsets = {.bits = 5, .step_s = 3e-9};
  EXPECT_THROW((void)source(1.0), InputError);
  around_ = {};
  around_.cover_glass.events = 1e6;
  EXPECT_THROW((void)source(1.0), InputError);
}

}  // namespace
}  // namespace dtof
