// SPDX-License-Identifier: Apache-2.0
#include "dtof/readout/matched_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

const MatchedFilterParameters kPulse{
    .np = 10, .sigma_bins = 19.3, .signal_events = 0.1, .background_events = 0.15};

std::vector<Detection> detections_of(std::initializer_list<Timestamp> timestamps) {
  std::vector<Detection> detections;
  for (const Timestamp timestamp : timestamps) {
    detections.push_back({static_cast<std::uint32_t>(detections.size()), timestamp});
  }
  return detections;
}

// Straight from the formula, from `first` to `last` in steps of `step` and without a cut template.
std::pair<double, double> brute_force(const MatchedFilterParameters& p, std::span<const Detection> detections,
                                      double first, double last, double step) {
  const double codes = std::ldexp(1.0, p.np);
  std::pair<double, double> best{first, -1.0};
  for (double tau = first; tau <= last; tau += step) {
    double sum = 0.0;
    for (const Detection& detection : detections) {
      if (detection.timestamp < codes - 1) {
        const double z = (detection.timestamp - tau) / p.sigma_bins;
        const double pulse = std::exp(-0.5 * z * z) / (p.sigma_bins * std::sqrt(2.0 * std::numbers::pi));
        const double more = p.returns.empty() ? 0.0 : p.returns[detection.timestamp];
        sum += std::log(1.0 + p.signal_events * pulse / (p.background_events / codes + more));
      }
    }
    if (sum > best.second) {
      best = {tau, sum};
    }
  }
  return best;
}

std::vector<Detection> random_frame(CounterRandom& random, double centre, int signal, int background) {
  std::normal_distribution<double> pulse(centre, kPulse.sigma_bins);
  std::vector<Detection> detections;
  for (int i = 0; i < signal + background; ++i) {
    const double time = i < signal ? pulse(random) : 1024.0 * random.uniform();
    if (time >= 0.0 && time < 1024.0) {
      detections.push_back({static_cast<std::uint32_t>(i), static_cast<Timestamp>(time)});
    }
  }
  return detections;
}

TEST(MatchedFilter, OneDetectionIsItsOwnCentre) {
  MatchedFilter filter(kPulse);
  EXPECT_NEAR(filter.estimate(detections_of({300})).position, 300.0, 1e-9);
  EXPECT_NEAR(filter.estimate(detections_of({300, 302})).position, 301.0, 1e-9);
  EXPECT_NEAR(filter.estimate(detections_of({300, 301})).position, 300.5, 1e-9);
  EXPECT_NEAR(filter.estimate(detections_of({0})).position, 0.0, 1e-9);
  EXPECT_NEAR(filter.estimate(detections_of({1022})).position, 1022.0, 1e-9);
}

TEST(MatchedFilter, NothingDetected) {
  MatchedFilter filter(kPulse);
  EXPECT_EQ(filter.estimate({}).position, 0.0);
  EXPECT_EQ(filter.estimate(detections_of({1023, 1023})).score, 0.0);
}

TEST(MatchedFilter, FramesDoNotLeakIntoEachOther) {
  MatchedFilter filter(kPulse);
  (void)filter.estimate(detections_of({100, 100, 100}));
  EXPECT_NEAR(filter.estimate(detections_of({300})).position, 300.0, 1e-9);
}

TEST(MatchedFilter, MaximumOfTheFormula) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 1, 0);
  MatchedFilter filter(kPulse);
  for (int frame = 0; frame < 40; ++frame) {
    const std::vector<Detection> detections = random_frame(random, 1024.0 * random.uniform(), 20, 60);
    const MatchedFilter::Result result = filter.estimate(detections);
    const auto [bin, score] = brute_force(kPulse, detections, 0.0, 1022.0, 1.0);
    EXPECT_NEAR(result.score, score, 1e-3 * score) << "frame " << frame;
    const double first = std::max(bin - 1.0, 0.0);
    const double last = std::min(bin + 1.0, 1022.0);
    const double position = brute_force(kPulse, detections, first, last, 1.0 / 128.0).first;
    EXPECT_NEAR(result.position, position, 0.05) << "frame " << frame;
  }
}

TEST(MatchedFilter, ReturnsAreBackground) {
  MatchedFilterParameters with_returns = kPulse;
  with_returns.returns.assign(1023, 0.0);
  for (std::size_t bin = 20; bin < 60; ++bin) {
    with_returns.returns[bin] = 0.002 * static_cast<double>(bin - 10);
  }
  CounterRandom random(test_seed(), 0, 0, 7);
  std::vector<Detection> detections = random_frame(random, 500.0, 30, 150);
  for (Timestamp code = 20; code < 60; ++code) {
    detections.push_back({0, code});
    detections.push_back({1, code});
  }
  const MatchedFilter::Result result = MatchedFilter(with_returns).estimate(detections);
  const auto [tau, sum] = brute_force(with_returns, detections, 0.0, 1022.0, 1.0);
  EXPECT_NEAR(result.position, tau, 1.0);
  EXPECT_NEAR(result.score, sum, 0.01 * sum);
  EXPECT_NEAR(result.position, 500.0, 20.0);
  EXPECT_LT(MatchedFilter(kPulse).estimate(detections).position, 100.0)
      << "without the returns, it takes the crosstalk";
}

TEST(MatchedFilter, ReachesTheSpreadOfTheMeanWithoutBackground) {
  SCOPED_TRACE(test_seed_message());
  CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), 2, 0);
  MatchedFilterParameters pure = kPulse;
  pure.background_events = 1e-9;
  MatchedFilter filter(pure);
  constexpr int kFrames = 2000;
  constexpr int kPhotons = 100;
  double squares = 0.0;
  double sum = 0.0;
  for (int frame = 0; frame < kFrames; ++frame) {
    // A code is its bin's begin: an arrival at 500.3 is position 499.8 plus rounding.
    const double error = filter.estimate(random_frame(random, 500.3, kPhotons, 0)).position - 499.8;
    squares += error * error;
    sum += error;
  }
  const double bound = kPulse.sigma_bins / std::sqrt(kPhotons);
  EXPECT_NEAR(std::sqrt(squares / kFrames), bound, 0.07 * bound);  // 4 standard errors
  EXPECT_NEAR(sum / kFrames, 0.0, 4.0 * bound / std::sqrt(kFrames));
}

TEST(MatchedFilter, HasTenBitsUnlessSaidOtherwise) { EXPECT_EQ(MatchedFilterParameters{}.np, 10); }

TEST(MatchedFilter, Refusals) {
  const auto changed = [](auto change) {
    MatchedFilterParameters parameters = kPulse;
    change(parameters);
    return [parameters] { const MatchedFilter filter(parameters); };
  };
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  EXPECT_THAT(changed([](auto& p) { p.np = 2; }), ThrowsMessage<InputError>(HasSubstr("NP is 2")));
  EXPECT_THAT(changed([](auto& p) { p.sigma_bins = 0.0; }), ThrowsMessage<InputError>(HasSubstr("sigma")));
  EXPECT_THAT(changed([](auto& p) { p.signal_events = -1.0; }),
              ThrowsMessage<InputError>(HasSubstr("signal")));
  EXPECT_THAT(changed([](auto& p) { p.background_events = NAN; }),
              ThrowsMessage<InputError>(HasSubstr("background")));
  MatchedFilter small({.np = 4, .sigma_bins = 1.0, .signal_events = 1.0, .background_events = 1.0});
  EXPECT_THROW((void)small.estimate(detections_of({16})), InputError);
}

TEST(MatchedFilter, RefusesReturnsThatItCannotTake) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  MatchedFilterParameters with_returns = kPulse;
  with_returns.returns.assign(1024, 0.0);
  EXPECT_THAT([&] { MatchedFilter{with_returns}; },
              ThrowsMessage<InputError>(HasSubstr("returns of 1024 bins")));
  with_returns.returns.assign(1023, 0.0);
  with_returns.returns[7] = -1.0;
  EXPECT_THAT([&] { MatchedFilter{with_returns}; },
              ThrowsMessage<InputError>(HasSubstr("returns of bin 7 are -1")));
}

TEST(MatchedFilter, MeasuredPulseIsFoundByItsCentroidWhicheverWayItLeans) {
  // Three quarters of the pulse in its first bin, a quarter six bins later: the centroid is 1.5 bins behind
  // the first bin's middle.
  const auto response =
      std::make_shared<const PulseResponse>(std::vector<double>{3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}, 1.0);
  MatchedFilter filter({.np = 8, .signal_events = 0.4, .background_events = 0.1, .response = response});
  std::vector<Detection> detections;
  for (std::uint32_t i = 0; i < 40; ++i) {
    detections.push_back({i, static_cast<Timestamp>(i % 4 == 3 ? 106 : 100)});
  }
  EXPECT_NEAR(filter.estimate(detections).position, 101.5, 0.51);
  // Events elsewhere that a mirrored pulse would explain better do not distract it.
  std::vector<Detection> mirrored;
  for (std::uint32_t i = 0; i < 40; ++i) {
    mirrored.push_back({i, static_cast<Timestamp>(i % 4 == 3 ? 94 : 100)});
  }
  EXPECT_GT(filter.estimate(detections).score, filter.estimate(mirrored).score);
}

TEST(MatchedFilter, SampledGaussianFindsWhatTheGaussianFinds) {
  constexpr double kSigma = 8.0;
  std::vector<double> samples;
  for (double time = -48.0; time < 48.0; time += 0.5) {
    const double z = (time + 0.25) / kSigma;
    samples.push_back(std::exp(-0.5 * z * z));
  }
  MatchedFilter gaussian({.np = 10, .sigma_bins = kSigma, .signal_events = 0.2, .background_events = 0.3});
  MatchedFilter sampled({.np = 10,
                         .sigma_bins = kSigma,
                         .signal_events = 0.2,
                         .background_events = 0.3,
                         .response = std::make_shared<const PulseResponse>(std::move(samples), 0.5)});
  std::vector<Detection> detections;
  for (std::uint32_t i = 0; i < 60; ++i) {
    detections.push_back({i, static_cast<Timestamp>(i % 3 == 0 ? 17 * i % 1000 : 400 + (7 * i) % 23)});
  }
  EXPECT_NEAR(sampled.estimate(detections).position, gaussian.estimate(detections).position, 0.05);
}

}  // namespace
}  // namespace dtof
