// SPDX-License-Identifier: Apache-2.0
// The photon models as statistics: detections of many equal pixels against the closed form, and proof that
// the same tests reject a model that is off by 2 %. Seeds are fixed (DTOF_TEST_SEED changes them); a right
// model fails one test in a million (kErrorRate).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/sensor/preset.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

constexpr int kPixels = 800;

/// Detections of kPixels equal pixels.
struct Detected {
  std::vector<std::vector<std::uint64_t>> slots;  // by slot and code; the sampler's are all in slot 0
  std::vector<double> numbers;                    // of every pixel
};

Detected read_streams(const StreamSource& source, const SensorModel& sensor) {
  const auto codes = std::size_t{1} << static_cast<unsigned>(sensor.np);
  Detected detected{std::vector(static_cast<std::size_t>(sensor.slots), std::vector<std::uint64_t>(codes)),
                    {}};
  for (int column = 0; column < source.columns(); ++column) {
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      const auto detections = stream.row(row);
      detected.numbers.push_back(static_cast<double>(detections.size()));
      std::size_t slot = 0;
      for (std::size_t i = 0; i < detections.size(); ++i) {
        const bool same = i > 0 && detections[i - 1].acquisition == detections[i].acquisition;
        slot = same ? slot + 1 : 0;
        ++detected.slots.at(slot).at(detections[i].timestamp);
      }
    }
  }
  return detected;
}

Detected read_sampler(const SampledSource& source, const SensorModel& sensor) {
  const std::int32_t codes = 1 << sensor.np;
  Detected detected{{std::vector<std::uint64_t>(static_cast<std::size_t>(codes))}, {}};
  const auto sampler = source.pixel_sampler();
  for (int column = 0; column < source.columns(); ++column) {
    for (int row = 0; row < source.rows(); ++row) {
      sampler->start_pixel(column, row);
      double number = 0.0;
      // In two measurements and two windows, as read-outs draw.
      const std::uint32_t half = source.acquisitions() / 2;
      for (const std::uint32_t acquisitions : {half, source.acquisitions() - half}) {
        const auto drawn = sampler->draw(acquisitions, 0, codes);
        number += static_cast<double>(drawn.size());
        for (const Timestamp code : drawn) {
          ++detected.slots[0].at(code);
        }
      }
      detected.numbers.push_back(number);
    }
  }
  return detected;
}

/// p-values of a set of detections being this pixel's.
struct Verdict {
  double times = 1.0;     // codes of every slot, given their number
  double numbers = 1.0;   // acquisitions with a detection in every slot
  double variance = 1.0;  // of the number of detections between pixels

  [[nodiscard]] double smallest() const { return std::min({times, numbers, variance}); }
};

Verdict judge(const Detected& detected, const SensorModel& sensor, const PixelRates& rates) {
  std::vector<std::vector<double>> expected = expected_slot_detections(sensor, rates);
  const auto total = [](const auto& values) {
    double sum = 0.0;
    for (const auto value : values) {
      sum += static_cast<double>(value);
    }
    return sum;
  };
  const double first = total(expected[0]);
  const double second = expected.size() > 1 ? total(expected[1]) : 0.0;
  const double mean = first + second;
  // N_1 + N_2 with N_2 <= N_1, both 0 or 1.
  const double variance = first + 3.0 * second - mean * mean;
  const double trials = static_cast<double>(detected.numbers.size()) * sensor.acquisitions;
  Verdict verdict;
  if (detected.slots.size() == 1 && expected.size() == 2) {
    for (std::size_t code = 0; code < expected[0].size(); ++code) {
      expected[0][code] += expected[1][code];
    }
    verdict.numbers = normal_p(total(detected.slots[0]) - trials * mean, std::sqrt(trials * variance));
    expected.pop_back();
  } else {
    verdict.numbers = std::min(binomial_p(total(detected.slots[0]), trials, first),
                               binomial_p(total(detected.slots[1]), trials, second));
  }
  for (std::size_t slot = 0; slot < detected.slots.size(); ++slot) {
    std::vector<double> shares = expected[slot];
    const double sum = total(shares);
    for (double& share : shares) {
      share /= sum;
    }
    verdict.times =
        std::min(verdict.times, chi_square_p(detected.slots[slot], shares, total(detected.slots[slot])));
  }
  // Pixels' numbers are normal to a good approximation: their squares are chi-square.
  double squares = 0.0;
  for (const double number : detected.numbers) {
    const double deviation = number - sensor.acquisitions * mean;
    squares += deviation * deviation / (sensor.acquisitions * variance);
  }
  const boost::math::chi_squared_distribution<double> distribution(
      static_cast<double>(detected.numbers.size()));
  verdict.variance = 2.0 * std::min(boost::math::cdf(distribution, squares),
                                    boost::math::cdf(boost::math::complement(distribution, squares)));
  return verdict;
}

enum class Model { kExact, kFastStream, kFastSampler };

Detected detect(Model model, const SensorModel& sensor, double depth_m, double klux,
                std::uint32_t frame = 0) {
  const PhotonSource exact(sensor, TargetMap(4, kPixels / 4, {.depth_m = depth_m, .reflectivity = 1.0}), klux,
                           test_seed(), frame);
  switch (model) {
    case Model::kExact:
      return read_streams(exact, sensor);
    case Model::kFastStream:
      return read_streams(FastPhotonSource(exact), sensor);
    case Model::kFastSampler:
      return read_sampler(FastPhotonSource(exact), sensor);
  }
  return {};
}

PixelRates rates_at(const SensorModel& sensor, double depth_m, double klux) {
  return PhotonSource(sensor, TargetMap(1, 1, {.depth_m = depth_m, .reflectivity = 1.0}), klux, 1)
      .rates(0, 0);
}

struct Case {
  const char* name;
  Model model;
  double depth_m;
  double klux;
};
void PrintTo(const Case& test, std::ostream* stream) { *stream << test.name; }

class GoodnessOfFit : public ::testing::TestWithParam<Case> {
 protected:
  SensorModel sensor_ = parse_preset("thesis");
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

TEST_P(GoodnessOfFit, TimesAndNumbersAreThoseOfTheClosedForm) {
  const Case& test = GetParam();
  const Verdict verdict = judge(detect(test.model, sensor_, test.depth_m, test.klux), sensor_,
                                rates_at(sensor_, test.depth_m, test.klux));
  EXPECT_GT(verdict.times, kErrorRate);
  EXPECT_GT(verdict.numbers, kErrorRate);
  EXPECT_GT(verdict.variance, kErrorRate);
}

TEST_P(GoodnessOfFit, TimeGateCutsTheClosedForm) {
  const Case& test = GetParam();
  sensor_.time_gate = TimeGate{3.3e-9, 27.7e-9};
  EXPECT_GT(judge(detect(test.model, sensor_, test.depth_m, test.klux), sensor_,
                  rates_at(sensor_, test.depth_m, test.klux))
                .smallest(),
            kErrorRate);
}

INSTANTIATE_TEST_SUITE_P(Models, GoodnessOfFit,
                         ::testing::Values(Case{"ExactOneMetre", Model::kExact, 1.0, 14.0},
                                           Case{"ExactFar", Model::kExact, 4.0, 50.0},
                                           Case{"ExactNear", Model::kExact, 0.2, 14.0},
                                           Case{"FastStreamOneMetre", Model::kFastStream, 1.0, 14.0},
                                           Case{"FastStreamFar", Model::kFastStream, 4.0, 50.0},
                                           Case{"FastStreamNear", Model::kFastStream, 0.2, 14.0},
                                           Case{"FastStreamDark", Model::kFastStream, 1.0, 0.0},
                                           Case{"FastSamplerOneMetre", Model::kFastSampler, 1.0, 14.0},
                                           Case{"FastSamplerFar", Model::kFastSampler, 4.0, 50.0},
                                           Case{"FastSamplerNear", Model::kFastSampler, 0.2, 14.0},
                                           Case{"FastSamplerDark", Model::kFastSampler, 1.0, 0.0}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// What is wrong with the model under test; the test has the true model.
struct Mistake {
  const char* name;
  std::function<void(SensorModel&)> make;
  double depth_factor = 1.0;
  double klux_factor = 1.0;
};
void PrintTo(const Mistake& mistake, std::ostream* stream) { *stream << mistake.name; }

class GoodnessOfFitPower : public ::testing::TestWithParam<Mistake> {};

TEST_P(GoodnessOfFitPower, RejectsAModelThatIsOffByTwoPercent) {
  SCOPED_TRACE(test_seed_message());
  constexpr double kDepth = 1.0;
  constexpr double kKlux = 14.0;
  const SensorModel truth = parse_preset("thesis");
  SensorModel wrong = truth;
  GetParam().make(wrong);
  for (const Model model : {Model::kExact, Model::kFastStream, Model::kFastSampler}) {
    const Detected detected =
        detect(model, wrong, kDepth * GetParam().depth_factor, kKlux * GetParam().klux_factor, 1);
    EXPECT_LT(judge(detected, truth, rates_at(truth, kDepth, kKlux)).smallest(), kErrorRate)
        << static_cast<int>(model);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, GoodnessOfFitPower,
    ::testing::Values(Mistake{"Signal", [](SensorModel& m) { m.signal_events_1m *= 1.02; }},
                      Mistake{"Background", [](SensorModel&) {}, 1.0, 1.02},
                      // 2 % of the pulse's width, which also sets its centre (2R/c + FWHM).
                      Mistake{"PulseWidth", [](SensorModel& m) { m.pulse_fwhm_s *= 1.02; }},
                      // 2 % of the distance.
                      Mistake{"Distance", [](SensorModel& m) { m.signal_events_1m *= 1.02 * 1.02; }, 1.02},
                      // 2 % of the range dead at its end.
                      Mistake{"Gate",
                              [](SensorModel& m) {
                                m.time_gate = TimeGate{0.0, 0.98 * 45e-9};
                              }},
                      // A dead time that loses 2 % of the second events and more.
                      Mistake{"SecondEvent", [](SensorModel& m) { m.slots = 1; }}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(GoodnessOfFitTimes, ArrivalTimesPassKolmogorovSmirnovAndShiftedOnesDoNot) {
  SCOPED_TRACE(test_seed_message());
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 300000;
  const PixelRates rates = rates_at(sensor, 1.0, 14.0);
  const double sigma = pulse_sigma_s(sensor.pulse_fwhm_s) / sensor.time_resolution_s();
  EventSampler sampler(sensor, EventSampler::kAll);
  const auto events =
      sampler.sample(rates, {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 9});
  const auto quantiles = [&](double shift_bins, double width) {
    std::vector<double> values;
    const auto below = [&](double t) {
      return 0.5 * std::erfc(-(t - rates.centre_bins - shift_bins) / (sigma * width) / std::numbers::sqrt2);
    };
    const auto cumulative = [&](double t) {
      return rates.background * t / 1024.0 + rates.signal * (below(t) - below(0.0));
    };
    for (const double position : events) {
      values.push_back(cumulative(std::fmod(position, 1024.0)) / cumulative(1024.0));
    }
    return values;
  };
  EXPECT_GT(kolmogorov_smirnov_p(quantiles(0.0, 1.0)), kErrorRate);
  EXPECT_LT(kolmogorov_smirnov_p(quantiles(0.02 * 45.5, 1.0)), kErrorRate);
  EXPECT_LT(kolmogorov_smirnov_p(quantiles(0.0, 1.05)), kErrorRate);
}

TEST(GoodnessOfFitTimes, GapsBetweenEventsAreExponential) {
  SCOPED_TRACE(test_seed_message());
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 600000;
  const PixelRates rates{.background = 0.4, .signal = 0.0, .centre_bins = 0.0};
  EventSampler sampler(sensor, EventSampler::kAll);
  const auto events =
      sampler.sample(rates, {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kPhotons), 0, 10});
  for (const double factor : {1.0, 1.02}) {
    std::vector<double> values;
    for (std::size_t i = 1; i < events.size(); ++i) {
      values.push_back(-std::expm1(-(events[i] - events[i - 1]) * rates.background * factor / 1024.0));
    }
    const double p = kolmogorov_smirnov_p(values);
    EXPECT_EQ(p > kErrorRate, factor == 1.0) << p;
  }
}

/// p-value of the numbers of neighbouring pixels being uncorrelated over many frames.
double correlation_p(const std::vector<double>& a, const std::vector<double>& b) {
  const auto count = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / count;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / count;
  double ab = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  // Fisher's transformation.
  return normal_p(std::atanh(ab / std::sqrt(aa * bb)), 1.0 / std::sqrt(count - 3.0));
}

TEST(GoodnessOfFitPixels, NeighboursAndFramesAreIndependent) {
  SCOPED_TRACE(test_seed_message());
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 300;
  const PhotonSource exact(sensor, TargetMap(2, 2000, {.depth_m = 1.0, .reflectivity = 1.0}), 14.0,
                           test_seed());
  const FastPhotonSource fast(exact);
  const FastPhotonSource fast_next(exact.at_frame(1));
  const PhotonSource exact_next = exact.at_frame(1);
  // Numbers of detections, and sums of times, of every pixel.
  const auto features = [&](const StreamSource& source, int column) {
    std::pair<std::vector<double>, std::vector<double>> result;
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      double sum = 0.0;
      for (const Detection& detection : stream.row(row)) {
        sum += detection.timestamp - 400.0;
      }
      result.first.push_back(static_cast<double>(stream.row(row).size()));
      result.second.push_back(sum);
    }
    return result;
  };
  const auto check = [&](const StreamSource& source, const StreamSource& next) {
    const auto left = features(source, 0);
    const auto right = features(source, 1);
    const auto later = features(next, 0);
    const auto shifted = [](std::vector<double> values) {
      std::rotate(values.begin(), values.begin() + 1, values.end());
      return values;
    };
    EXPECT_GT(correlation_p(left.first, right.first), kErrorRate);
    EXPECT_GT(correlation_p(left.second, right.second), kErrorRate);
    EXPECT_GT(correlation_p(left.first, later.first), kErrorRate);
    EXPECT_GT(correlation_p(left.first, shifted(left.first)), kErrorRate);
    EXPECT_GT(correlation_p(left.second, shifted(left.second)), kErrorRate);
    // A model whose pixels share 2 % of their numbers' spread times ten is noticed: r = 0.2.
    std::vector<double> mixed = right.first;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
      mixed[i] += 0.2 * left.first[i];
    }
    EXPECT_LT(correlation_p(left.first, mixed), kErrorRate);
  };
  check(exact, exact_next);
  check(fast, fast_next);
}

TEST(FastPhotonSource, WindowsTakeTheirShareAndNothingElse) {
  SCOPED_TRACE(test_seed_message());
  const SensorModel sensor = parse_preset("thesis");
  for (const double depth : {0.2, 1.0, 4.0}) {
    const PhotonSource exact(sensor, TargetMap(1, 1000, {.depth_m = depth, .reflectivity = 1.0}), 14.0,
                             test_seed());
    const std::vector<double> expected = expected_detections(sensor, exact.rates(0, 0));
    const auto sampler = FastPhotonSource(exact).pixel_sampler();
    for (const auto& [first, last] :
         {std::pair{-40, 130}, {190, 215}, {600, 603}, {1000, 2000}, {700, 700}}) {
      double count = 0.0;
      for (int row = 0; row < 1000; ++row) {
        sampler->start_pixel(0, row);
        for (const Timestamp code : sampler->draw(1000, first, last)) {
          ASSERT_TRUE(code >= first && code < std::min(last, 1024)) << code;
          count += 1.0;
        }
      }
      double mean = 0.0;
      for (int code = std::max(first, 0); code < std::min(last, 1024); ++code) {
        mean += 1e6 * expected[static_cast<std::size_t>(code)];
      }
      // Poisson spread is more than what pile-up leaves.
      EXPECT_GT(normal_p(count - mean, std::sqrt(std::max(mean, 1e-9))), kErrorRate) << depth << " " << first;
    }
  }
}

TEST(FastPhotonSource, NoWindowGetsACodeOutside) {
  // At the ends of narrow windows over the pulse the table's inverse does not meet the table exactly.
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 1;
  for (const double depth : {1.0, 2.3, 4.0}) {
    const PhotonSource exact(sensor, TargetMap(1, 1, {.depth_m = depth, .reflectivity = 1.0}), 14.0, 1);
    const auto sampler = FastPhotonSource(exact).pixel_sampler();
    sampler->start_pixel(0, 0);
    const auto centre = static_cast<std::int32_t>(exact.rates(0, 0).centre_bins);
    for (const std::int32_t width : {1, 5, 32}) {
      for (std::int32_t first = centre - 80; first < centre + 80; ++first) {
        for (const Timestamp code : sampler->draw(20000, first, first + width)) {
          ASSERT_GE(code, first) << depth;
          ASSERT_LT(code, first + width) << depth;
        }
      }
    }
  }
}

TEST(FastPhotonSource, RepeatsForASeedWhateverElseIsDrawn) {
  const SensorModel sensor = parse_preset("thesis");
  TargetMap targets(3, 4, {.depth_m = 1.0, .reflectivity = 1.0});
  targets.at(1, 2) = {.depth_m = 2.5, .reflectivity = 0.4};
  const FastPhotonSource source(PhotonSource(sensor, targets, 14.0, 5));
  EXPECT_EQ(source.column(1), source.column(1));
  EXPECT_NE(source.column(0), source.column(2));
  const auto one = source.pixel_sampler();
  const auto other = source.pixel_sampler();
  other->start_pixel(0, 0);
  (void)other->draw(3333, 0, 1024);
  one->start_pixel(1, 2);
  other->start_pixel(1, 2);
  const auto a = one->draw(100, 0, 1024);
  const auto b = other->draw(100, 0, 1024);
  EXPECT_TRUE(std::ranges::equal(a, b));
  EXPECT_FALSE(a.empty());
}

TEST(FastPhotonSource, DarkPixelsAndEmptyFramesGiveNothing) {
  SensorModel sensor = parse_preset("thesis");
  sensor.dark_count_rate_hz = 0.0;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double depth : {0.0, 9.0, infinity}) {
    const PhotonSource exact(sensor, TargetMap(2, 3, {.depth_m = depth, .reflectivity = 1.0}), 0.0, 1);
    const FastPhotonSource fast(exact);
    EXPECT_EQ(fast.column(0).rows(), 3);
    EXPECT_EQ(fast.column(0).detection_count(), 0U);
    EXPECT_EQ(MeanPhotonSource(exact).column(0).detection_count(), 0U);
    const auto sampler = fast.pixel_sampler();
    sampler->start_pixel(1, 2);
    EXPECT_TRUE(sampler->draw(3333, 0, 1024).empty());
  }
  sensor.acquisitions = 0;
  const PhotonSource exact(sensor, TargetMap(1, 1, {.depth_m = 1.0, .reflectivity = 1.0}), 14.0, 1);
  EXPECT_EQ(FastPhotonSource(exact).column(0).detection_count(), 0U);
  EXPECT_EQ(MeanPhotonSource(exact).column(0).detection_count(), 0U);
}

TEST(FastPhotonSource, RefusesWhatItDoesNotModel) {
  const auto source = [](const std::function<void(SensorModel&)>& change) {
    SensorModel sensor = parse_preset("thesis");
    change(sensor);
    return PhotonSource(sensor, TargetMap(2, 2, {.depth_m = 1.0, .reflectivity = 1.0}), 14.0, 1);
  };
  for (const auto& change :
       {std::function<void(SensorModel&)>([](SensorModel& m) { m.dead_time_s = 1e-9; }),
        std::function<void(SensorModel&)>([](SensorModel& m) { m.binning = 2; }),
        std::function<void(SensorModel&)>([](SensorModel& m) { m.coincidence_window_s = 1e-9; })}) {
    EXPECT_THROW(FastPhotonSource{source(change)}, InputError);
    EXPECT_THROW(MeanPhotonSource{source(change)}, InputError);
    EXPECT_THROW((void)expected_detections(source(change).model(), {}), InputError);
  }
}

TEST(MeanPhotonSource, HasTheExpectedHistogram) {
  SensorModel sensor = parse_preset("thesis");
  sensor.acquisitions = 33333;
  for (const double depth : {0.3, 1.0, 4.0}) {
    const PhotonSource exact(sensor, TargetMap(1, 1, {.depth_m = depth, .reflectivity = 1.0}), 14.0, 1);
    const std::vector<double> expected = expected_detections(sensor, exact.rates(0, 0));
    std::vector<double> counts(1024, 0.0);
    const ColumnStream stream = MeanPhotonSource(exact).column(0);
    for (const Detection& detection : stream.row(0)) {
      counts[detection.timestamp] += 1.0;
    }
    // Far below Poisson noise: the sequence is spread evenly, a few detections off on any interval.
    double difference = 0.0;
    for (std::size_t code = 0; code < counts.size(); ++code) {
      difference += counts[code] - sensor.acquisitions * expected[code];
      ASSERT_LT(std::abs(difference), 12.0) << code;
    }
  }
}

}  // namespace
}  // namespace dtof
