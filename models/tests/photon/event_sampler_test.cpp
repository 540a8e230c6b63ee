// SPDX-License-Identifier: Apache-2.0
#include "dtof/photon/event_sampler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dtof/core/log_gamma.hpp"
#include "dtof/core/random.hpp"
#include "dtof/photon/physics.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

SensorModel test_model(std::uint32_t acquisitions) {
  SensorModel model;
  model.acquisitions = acquisitions;
  return model;
}

double sigma_bins(const SensorModel& model) {
  return pulse_sigma_s(model.pulse_fwhm_s) / model.time_resolution_s();
}

/// Rates below and above the mean from which the sampler walks in time order.
struct RateCase {
  const char* name;
  PixelRates rates;
};

void PrintTo(const RateCase& rate_case, std::ostream* stream) { *stream << rate_case.name; }

class EventSamplerRates : public ::testing::TestWithParam<RateCase> {
 protected:
  [[nodiscard]] std::span<const double> sample(EventSampler& sampler) const {
    return sampler.sample(GetParam().rates, random_);
  }

  CounterRandom random_{test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 0};
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

// Enough to notice rates and times that are off by 2 %.
constexpr std::uint32_t kAcquisitions = 200000;

/// Events of every acquisition, split from the frame's axis.
std::vector<std::vector<double>> split(std::span<const double> events, const SensorModel& model) {
  const double code_count = std::ldexp(1.0, model.np);
  std::vector<std::vector<double>> acquisitions(model.acquisitions);
  for (const double event : events) {
    const double acquisition = std::floor(event / code_count);
    acquisitions.at(static_cast<std::size_t>(acquisition)).push_back(event - acquisition * code_count);
  }
  return acquisitions;
}

TEST_P(EventSamplerRates, EventsAreInTimeOrder) {
  const SensorModel model = test_model(kAcquisitions);
  EventSampler sampler(model, 3);
  const auto events = sample(sampler);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end()));
  EXPECT_GT(events.size(), 0U);
}

TEST_P(EventSamplerRates, NumbersAndArrivalTimesArePoisson) {
  const SensorModel model = test_model(kAcquisitions);
  EventSampler sampler(model, EventSampler::kAll);
  const auto acquisitions = split(sample(sampler), model);
  const auto means = bin_means(1024, GetParam().rates.background, GetParam().rates.signal,
                               GetParam().rates.centre_bins, sigma_bins(model));
  double total = 0.0;
  for (const double mean : means) {
    total += mean;
  }

  std::vector<std::uint64_t> bins(1024, 0);
  std::vector<double> frame_means = means;
  std::vector<std::uint64_t> numbers(200, 0);
  std::vector<double> poisson(200);
  for (const auto& events : acquisitions) {
    ++numbers.at(events.size());
    for (const double event : events) {
      ++bins.at(static_cast<std::size_t>(event));
    }
  }
  for (double& mean : frame_means) {
    mean *= kAcquisitions;
  }
  for (std::size_t n = 0; n < poisson.size(); ++n) {
    const auto number = static_cast<double>(n);
    poisson[n] = std::exp(number * std::log(total) - total - log_gamma(number + 1.0));
  }
  EXPECT_GT(poisson_chi_square_p(bins, frame_means), kErrorRate);
  EXPECT_GT(chi_square_p(numbers, poisson, kAcquisitions), kErrorRate);
}

TEST_P(EventSamplerRates, FirstAndSecondEventFollowOrderStatistics) {
  // Pile-up: with mean Lambda before a time, fewer than k events came with the Poisson probability of < k.
  const SensorModel model = test_model(kAcquisitions);
  EventSampler sampler(model, 2);
  const auto acquisitions = split(sample(sampler), model);
  const auto means = bin_means(1024, GetParam().rates.background, GetParam().rates.signal,
                               GetParam().rates.centre_bins, sigma_bins(model));
  std::vector<std::uint64_t> first(1024, 0);
  std::vector<std::uint64_t> second(1024, 0);
  for (const auto& events : acquisitions) {
    if (!events.empty()) {
      ++first.at(static_cast<std::size_t>(events[0]));
    }
    if (events.size() > 1) {
      ++second.at(static_cast<std::size_t>(events[1]));
    }
  }
  std::vector<double> first_probability(1024);
  std::vector<double> second_probability(1024);
  double before = 0.0;
  for (std::size_t i = 0; i < 1024; ++i) {
    const double after = before + means[i];
    first_probability[i] = std::exp(-before) - std::exp(-after);
    second_probability[i] = std::exp(-before) * (1.0 + before) - std::exp(-after) * (1.0 + after);
    before = after;
  }
  EXPECT_GT(chi_square_p(first, first_probability, kAcquisitions), kErrorRate);
  EXPECT_GT(chi_square_p(second, second_probability, kAcquisitions), kErrorRate);
}

TEST_P(EventSamplerRates, DeadTimeIsNonParalysable) {
  // Renewal: after an event the next one is that of the same process, begun again a dead time later.
  SensorModel model = test_model(kAcquisitions);
  model.dead_time_s = 5e-9;
  const double dead_bins = model.dead_time_s / model.time_resolution_s();
  EventSampler sampler(model, 2);
  const auto acquisitions = split(sample(sampler), model);
  const PixelRates& rates = GetParam().rates;
  const auto mean_before = [&](double t) {
    const auto phi = [&](double x) {
      return 0.5 * std::erfc(-(x - rates.centre_bins) / sigma_bins(model) / std::sqrt(2.0));
    };
    return rates.background * t / 1024.0 + rates.signal * (phi(t) - phi(0.0));
  };
  // By the time change, the mean between the end of the dead time and the next event is exponential.
  double trials = 0.0;
  std::vector<std::uint64_t> deciles(10, 0);
  for (const auto& events : acquisitions) {
    if (events.empty()) {
      continue;
    }
    const double restart = std::min(events[0] + dead_bins, 1024.0);
    const double to_end = mean_before(1024.0) - mean_before(restart);
    if (to_end < 1e-3) {
      continue;  // nothing can follow
    }
    if (events.size() > 1) {
      ASSERT_GE(events[1] - events[0], dead_bins * (1.0 - 1e-9));
    }
    // Probability integral transform, the events that miss the range's end filled up at random.
    const double walked = events.size() > 1 ? mean_before(events[1]) - mean_before(restart) : to_end;
    double quantile = -std::expm1(-walked);
    if (events.size() < 2) {
      quantile = 1.0 - random_.uniform() * std::exp(-to_end);
    }
    trials += 1.0;
    ++deciles[std::min<std::size_t>(9, static_cast<std::size_t>(quantile * 10.0))];
  }
  ASSERT_GT(trials, 1000.0);
  EXPECT_GT(chi_square_p(deciles, std::vector<double>(10, 0.1), trials), kErrorRate);
}

TEST_P(EventSamplerRates, DeadTimeLongerThanTheRangeLeavesOneEvent) {
  SensorModel model = test_model(kAcquisitions);
  model.dead_time_s = 1.0;
  for (const std::size_t keep : {std::size_t{2}, EventSampler::kAll}) {
    EventSampler sampler(model, keep);
    const auto means = bin_means(1024, GetParam().rates.background, GetParam().rates.signal,
                                 GetParam().rates.centre_bins, sigma_bins(model));
    double total = 0.0;
    for (const double mean : means) {
      total += mean;
    }
    std::uint64_t hit = 0;
    for (const auto& events : split(sample(sampler), model)) {
      ASSERT_LE(events.size(), 1U);
      hit += events.size();
    }
    const double miss = std::exp(-total);
    if (miss * kAcquisitions < 0.01) {
      EXPECT_GE(hit, kAcquisitions - 2);  // three misses have a probability below 2e-7
    } else {
      EXPECT_GT(binomial_p(static_cast<double>(hit), kAcquisitions, 1.0 - miss), kErrorRate);
    }
  }
}

TEST_P(EventSamplerRates, GateLetsOnlyItsOwnEventsThrough) {
  SensorModel model = test_model(kAcquisitions);
  model.time_gate = TimeGate{200.25 * model.time_resolution_s(), 210.5 * model.time_resolution_s()};
  EventSampler sampler(model, 2);
  const auto acquisitions = split(sample(sampler), model);
  // In quarter bins the gate's ends are bin borders.
  const auto means = bin_means(4096, GetParam().rates.background, GetParam().rates.signal,
                               4.0 * GetParam().rates.centre_bins, 4.0 * sigma_bins(model));
  std::vector<std::uint64_t> first(4096, 0);
  std::vector<double> probability(4096, 0.0);
  double before = 0.0;
  for (std::size_t i = 801; i < 842; ++i) {
    probability[i] = std::exp(-before) - std::exp(-before - means[i]);
    before += means[i];
  }
  for (const auto& events : acquisitions) {
    for (const double event : events) {
      ASSERT_GE(event, 200.25 - 1e-6);
      ASSERT_LT(event, 210.5 + 1e-6);
    }
    if (!events.empty()) {
      ++first.at(static_cast<std::size_t>(events[0] * 4.0));
    }
  }
  EXPECT_GT(chi_square_p(first, probability, kAcquisitions), kErrorRate);
}

INSTANTIATE_TEST_SUITE_P(
    Rates, EventSamplerRates,
    ::testing::Values(RateCase{"Background", {.background = 0.55, .signal = 0.0, .centre_bins = 0.0}},
                      RateCase{"Sparse", {.background = 0.15, .signal = 0.3, .centre_bins = 197.35}},
                      RateCase{"PileUp", {.background = 0.5, .signal = 5.0, .centre_bins = 197.35}},
                      RateCase{"DensePulse", {.background = 0.15, .signal = 40.0, .centre_bins = 197.35}},
                      RateCase{"DenseBackground", {.background = 50.0, .signal = 2.0, .centre_bins = 197.35}},
                      RateCase{"SortedAfterwards",
                               {.background = 1.0, .signal = 17.0, .centre_bins = 197.35}}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(EventSampler, ArrivalsOfTheSignalAreGaussian) {
  SCOPED_TRACE(test_seed_message());
  const SensorModel model = test_model(100000);
  EventSampler sampler(model, EventSampler::kAll);
  const PixelRates rates = {.background = 0.0, .signal = 1.0, .centre_bins = 500.0};
  const CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 1);
  double count = 0.0;
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (const auto& events : split(sampler.sample(rates, random), model)) {
    for (const double event : events) {
      count += 1.0;
      sum += event - 500.0;
      sum_of_squares += (event - 500.0) * (event - 500.0);
    }
  }
  const double sigma = sigma_bins(model);
  EXPECT_GT(normal_p(sum / count, sigma / std::sqrt(count)), kErrorRate);
  EXPECT_GT(normal_p(sum_of_squares / count - sigma * sigma, sigma * sigma * std::sqrt(2.0 / count)),
            kErrorRate);
}

TEST(EventSampler, PulseAcrossTheRangesEndsLosesItsOutside) {
  SCOPED_TRACE(test_seed_message());
  const SensorModel model = test_model(50000);
  for (const double signal : {0.5, 60.0}) {
    for (const double centre : {0.0, 1024.0}) {
      const CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 2);
      EventSampler sampler(model, 1);
      std::uint64_t hit = 0;
      for (const auto& events : split(
               sampler.sample({.background = 0.0, .signal = signal, .centre_bins = centre}, random), model)) {
        hit += events.empty() ? 0 : 1;
      }
      if (signal < 1.0) {
        EXPECT_GT(binomial_p(static_cast<double>(hit), 50000.0, -std::expm1(-signal / 2.0)), kErrorRate);
      } else {
        EXPECT_EQ(hit, 50000U);  // a miss has probability 5e-9
      }
    }
  }
}

TEST(EventSampler, APulsesTailReachesIntoTheRange) {
  SCOPED_TRACE(test_seed_message());
  const SensorModel model = test_model(50000);
  // A centre so many sigma outside, and a pulse so bright that some per cent of the acquisitions see its
  // tail.
  for (const auto& [sigmas, signal] : {std::pair(2.5, 10.0), std::pair(3.5, 200.0), std::pair(5.0, 1e5)}) {
    for (const double centre : {-sigmas * sigma_bins(model), 1024.0 + sigmas * sigma_bins(model)}) {
      SCOPED_TRACE(testing::Message() << centre);
      const CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 4);
      EventSampler sampler(model, 1);
      double hit = 0.0;
      for (const auto& events : split(
               sampler.sample({.background = 0.0, .signal = signal, .centre_bins = centre}, random), model)) {
        hit += events.empty() ? 0.0 : 1.0;
      }
      const double tail = 0.5 * std::erfc(sigmas / std::sqrt(2.0));
      EXPECT_GT(binomial_p(hit, 50000.0, -std::expm1(-signal * tail)), kErrorRate);
    }
  }
}

TEST(EventSampler, SurvivesExtremeRates) {
  const CounterRandom random(test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 3);
  for (const double fwhm : {4.4e-12, 2e-9, 45e-9}) {
    for (const double rate : {0.0, 1e-300, 1e-12, 1.0, 1e6, 1e300}) {
      for (const double centre : {-1e6, 0.0, 3.0, 512.5, 1023.999, 1024.0, 1e9}) {
        SensorModel model = test_model(100);
        model.pulse_fwhm_s = fwhm;
        EventSampler sampler(model, 2);
        for (const PixelRates& rates :
             {PixelRates{.background = rate, .signal = 0.1, .centre_bins = centre},
              PixelRates{.background = 0.1, .signal = rate, .centre_bins = centre}}) {
          const auto events = sampler.sample(rates, random);
          ASSERT_TRUE(std::is_sorted(events.begin(), events.end())) << rate << " " << centre;
          for (const double event : events) {
            ASSERT_TRUE(event >= 0.0 && event < 102400.0) << event << " " << rate << " " << centre;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace dtof
