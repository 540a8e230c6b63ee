// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/linear_code.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "dtof/metrics/cramer_rao.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/photon/photon_source.hpp"
#include "dtof/rival/code_matcher.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Le;
using testing::ThrowsMessage;

SensorModel of_np(int np) {
  SensorModel sensor;
  sensor.np = np;
  return sensor;
}

/// Two counters over 8 codes: +1 and -2 in the lower half, -1 and +2 in the upper.
LinearCode two_counters(FullCounter full) {
  LinearCode code{.counters = 2, .weights = {}, .count_bits = 4, .is_signed = true, .full = full};
  for (int x = 0; x < 8; ++x) {
    code.weights.push_back(static_cast<std::int16_t>(x < 4 ? 1 : -1));
    code.weights.push_back(static_cast<std::int16_t>(x < 4 ? -2 : 2));
  }
  return code;
}

TEST(LinearCode, AddsTheNumbersOfEachDetection) {
  const std::unique_ptr<Rival> rival = make_linear_code(of_np(3), two_counters(FullCounter::kStays));
  EXPECT_THAT(read_one_frame(*rival, one_each(std::array{0, 3, 4, 1, 7})), ElementsAre(2, -4))
      << "7 is no detection";
  EXPECT_EQ(rival->bits_per_pixel(), 2 * 4);
}

// Limits of 4 bits with sign are -7 and 7: the fourth detection would make -8.
TEST(LinearCode, AFullCounterStaysOrFreezesThePixel) {
  const std::vector<Detection> detections = one_each(std::array{0, 0, 0, 0, 0, 5});
  const std::unique_ptr<Rival> stays = make_linear_code(of_np(3), two_counters(FullCounter::kStays));
  EXPECT_THAT(read_one_frame(*stays, detections), ElementsAre(4, -5));
  const std::unique_ptr<Rival> freezes = make_linear_code(of_np(3), two_counters(FullCounter::kFreezes));
  EXPECT_THAT(read_one_frame(*freezes, detections), ElementsAre(3, -6));
  EXPECT_EQ(freezes->bits_per_pixel(), 2 * 4 + 1);
}

// Counters of no sign have 0 .. 2^bits - 1.
TEST(LinearCode, UnsignedCountersUseAllTheirBits) {
  LinearCode code{.counters = 1,
                  .weights = std::vector<std::int16_t>(8, 3),
                  .count_bits = 4,
                  .is_signed = false,
                  .full = FullCounter::kStays};
  EXPECT_THAT(read_one_frame(*make_linear_code(of_np(3), code), one_each(std::array{0, 0, 0, 0, 0, 0})),
              ElementsAre(15));
}

/// Every detection is checked, with numbers of 64 bits.
RivalWords reference_words(const LinearCode& code, const std::vector<Detection>& detections, int np) {
  const std::int64_t most = code.is_signed ? (std::int64_t{1} << (code.count_bits - 1)) - 1
                                           : (std::int64_t{1} << code.count_bits) - 1;
  const std::int64_t least = code.is_signed ? -most : 0;
  std::vector<std::int64_t> sums(code.counters, 0);
  for (const Detection& detection : detections) {
    if (detection.timestamp == (1 << np) - 1) {
      continue;
    }
    std::vector<std::int64_t> next = sums;
    bool fits = true;
    for (std::size_t k = 0; k < code.counters; ++k) {
      next[k] += code.weights[detection.timestamp * code.counters + k];
      fits = fits && next[k] <= most && next[k] >= least;
      next[k] = std::clamp(next[k], least, most);
    }
    if (!fits && code.full == FullCounter::kFreezes) {
      break;
    }
    sums = next;
  }
  return {sums.begin(), sums.end()};
}

TEST(LinearCode, EqualsAReferenceThatChecksEveryDetection) {
  CounterRandom random(1, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  for (int trial = 0; trial < 60; ++trial) {
    LinearCode code{.counters = 1 + random() % 5,
                    .weights = {},
                    .count_bits = 4 + static_cast<int>(random() % 6),
                    .is_signed = random() % 2 == 0,
                    .full = random() % 2 == 0 ? FullCounter::kStays : FullCounter::kFreezes};
    for (std::size_t i = 0; i < code.counters * 16; ++i) {
      const int number = static_cast<int>(random() % 9);
      code.weights.push_back(static_cast<std::int16_t>(code.is_signed ? number - 4 : number));
    }
    std::vector<int> timestamps;
    for (std::uint32_t i = 0; i < random() % 800; ++i) {
      timestamps.push_back(static_cast<int>(random() % 16));
    }
    const std::vector<Detection> detections = one_each(timestamps);
    EXPECT_EQ(read_one_frame(*make_linear_code(of_np(4), code), detections),
              reference_words(code, detections, 4))
        << trial;
  }
}

TEST(FourierCode, HarmonicsOfBothKinds) {
  using Wave = CodeWave;
  EXPECT_THAT(truncated_fourier(4),
              ElementsAre(Wave{1, false}, Wave{1, true}, Wave{2, false}, Wave{2, true}));
  EXPECT_THAT(gray_fourier(8, 100),
              ElementsAre(Wave{1, false}, Wave{1, true}, Wave{2, false}, Wave{2, true}, Wave{4, false},
                          Wave{4, true}, Wave{8, false}, Wave{8, true}));
  // Above the largest harmonic, the lowest not yet used.
  EXPECT_THAT(gray_fourier(8, 4), ElementsAre(Wave{1, false}, Wave{1, true}, Wave{2, false}, Wave{2, true},
                                              Wave{3, false}, Wave{3, true}, Wave{4, false}, Wave{4, true}));
}

TEST(FourierCode, NumbersOfOneToFourBits) {
  const std::array<CodeWave, 1> cosine = {CodeWave{1, false}};
  EXPECT_THAT(wave_weights(3, cosine, 1), ElementsAre(1, 1, -1, -1, -1, -1, 1, 1));
  EXPECT_THAT(wave_weights(3, cosine, 2), ElementsAre(1, 0, 0, -1, -1, 0, 0, 1));
  EXPECT_THAT(wave_weights(3, cosine, 4), ElementsAre(6, 3, -3, -6, -6, -3, 3, 6));
  for (int bits = 1; bits <= 4; ++bits) {
    const std::vector<CodeWave> waves = truncated_fourier(16);
    int sum = 0;
    for (const std::int16_t weight : wave_weights(10, waves, bits)) {
      EXPECT_LE(std::abs(weight), bits == 1 ? 1 : (1 << (bits - 1)) - 1);
      sum += weight;
    }
    EXPECT_EQ(sum, 0) << "flat background adds nothing over all counters and codes";
  }
  EXPECT_THAT([&] { (void)wave_weights(3, cosine, 0); },
              ThrowsMessage<InputError>(HasSubstr("code of 0 bits")));
}

// The paper's claim: the sketch is the histogram's Fourier transform. Numbers of 8 bits leave their rounding.
TEST(Sketch, IsTheFourierTransformOfTheDetections) {
  const SensorModel sensor;
  const std::unique_ptr<Rival> sketch = make_sketch(sensor, 2);
  const std::vector<int> timestamps = {5, 100, 101, 102, 512, 600, 900, 1022, 77, 300};
  const RivalWords words = read_one_frame(*sketch, one_each(timestamps));
  ASSERT_EQ(words.size(), 4U);
  for (int m = 1; m <= 2; ++m) {
    std::complex<double> z;
    for (const int x : timestamps) {
      z += std::polar(127.0, 2.0 * std::numbers::pi * m * (x + 0.5) / 1024.0);
    }
    EXPECT_NEAR(words[static_cast<std::size_t>(2 * m - 2)], z.real(),
                0.5 * static_cast<double>(timestamps.size()));
    EXPECT_NEAR(words[static_cast<std::size_t>(2 * m - 1)], z.imag(),
                0.5 * static_cast<double>(timestamps.size()));
  }
}

// Size 1 has a closed form: the angle of z.
TEST(Sketch, OfSizeOneIsTheCircularMean) {
  const SensorModel sensor;
  const std::unique_ptr<Rival> sketch = make_sketch(sensor, 1);
  const std::vector<Detection> pixel = noise_free_pulse(sensor, 400.0, 1000.0, 0);
  const RivalWords words = read_one_frame(*sketch, pixel);
  const double turn = std::atan2(words[1], words[0]) / (2.0 * std::numbers::pi);
  EXPECT_NEAR(sketch->decode(words).position, turn * 1024.0 - 0.5, 0.05);
  EXPECT_NEAR(sketch->decode(words).position, 400.0, 0.5);
}

/// Root mean square error of a sketch over the single pixel's bound, its median's bias taken away: 2 m, 14
/// klux.
double error_over_bound(int size) {
  const SensorModel sensor;
  const PhotonSource photons(sensor, TargetMap(1, 400, {2.0, 1.0}), 14.0, 1);
  const std::unique_ptr<Rival> sketch = make_sketch(sensor, size);
  const ColumnStream column = photons.column(0);
  std::vector<double> positions;
  positions.reserve(400);
  for (int row = 0; row < 400; ++row) {
    positions.push_back(sketch->decode(read_one_frame(*sketch, column.row(row))).position);
  }
  const double middle = median(positions);
  double sum = 0.0;
  for (const double position : positions) {
    sum += (position - middle) * (position - middle);
  }
  const PixelRates rates = photons.rates(0, 0);
  const double bound = cramer_rao_bound({.signal_events = rates.signal,
                                         .background_events = rates.background,
                                         .centre_bins = rates.centre_bins,
                                         .sigma_bins = sensor.pulse_sigma_s() / sensor.time_resolution_s(),
                                         .np = sensor.np,
                                         .acquisitions = static_cast<double>(sensor.acquisitions),
                                         .kept_events = sensor.slots});
  return std::sqrt(sum / 400.0) / bound;
}

// The paper's claim: the error soon comes to the Cramer-Rao bound as the sketch grows, at sizes far below
// 2^NP.
TEST(Sketch, ComesToTheBoundWithModestSizes) {
  const double one = error_over_bound(1);
  const double two = error_over_bound(2);
  const double four = error_over_bound(4);
  const double sixteen = error_over_bound(16);
  EXPECT_GT(one, 1.5 * two);
  EXPECT_GT(two, 1.5 * four);
  EXPECT_GT(four, sixteen);
  EXPECT_LT(sixteen, 1.15);
  RecordProperty("error_over_bound_1_2_4_16",
                 fmt::format("{:.2f} {:.2f} {:.2f} {:.2f}", one, two, four, sixteen));
}

TEST(Sketch, NoFrameFillsItsCounters) {
  SensorModel sensor;
  sensor.acquisitions = 1000;
  const std::unique_ptr<Rival> sketch = make_sketch(sensor, 1);
  std::vector<Detection> all;
  for (std::uint32_t a = 0; a < 1000; ++a) {
    all.push_back({a, 0});
    all.push_back({a, 0});
  }
  EXPECT_EQ(read_one_frame(*sketch, all)[0], 2000 * 127);
}

TEST(SplineSketch, SharesADetectionBetweenTwoNeighbours) {
  const std::vector<std::int16_t> weights = spline_weights(4, 4);  // a knot every 4 codes; x + 1/2 over 4
  const auto row = [&](std::size_t x) {
    return std::vector<std::int16_t>(weights.begin() + static_cast<std::ptrdiff_t>(4 * x),
                                     weights.begin() + static_cast<std::ptrdiff_t>(4 * x + 4));
  };
  EXPECT_THAT(row(0), ElementsAre(3, 1, 0, 0));   // f = 1/8, rounded up to a quarter
  EXPECT_THAT(row(2), ElementsAre(1, 3, 0, 0));   // 5/8
  EXPECT_THAT(row(13), ElementsAre(2, 0, 0, 2));  // 3/8, and the last knot's neighbour is the first
  for (std::size_t x = 0; x < 16; ++x) {
    const std::vector<std::int16_t> numbers = row(x);
    EXPECT_EQ(std::accumulate(numbers.begin(), numbers.end(), 0), 4) << x;
  }
}

TEST(TwoCorrelations, MovesTowardsEachDetection) {
  const std::unique_ptr<Rival> rival = make_two_correlations(of_np(4), 1);
  // Tops at codes 0 and 4 of 16; w(0) = (6, 1), w(8) = (-6, -1).
  const RivalWords first = read_one_frame(*rival, one_each(std::array{0}));
  EXPECT_THAT(first, ElementsAre(6, 1));
  EXPECT_THAT(read_one_frame(*rival, one_each(std::array{0, 8})), ElementsAre(6 - 6 - 3, 1 - 1 - 1));
  EXPECT_EQ(rival->bits_per_pixel(), 2 * 5);
  // As long as the pulse stays, the average ends at 2^shift times the wave, and no word passes its bits.
  std::vector<int> many(500, 1);
  EXPECT_THAT(read_one_frame(*rival, one_each(many)), Each(Le(15)));
}

TEST(TwoCorrelations, OldDetectionsLoseTheirWeight) {
  SensorModel sensor;
  sensor.acquisitions = 5000;
  const std::unique_ptr<Rival> rival = make_two_correlations(sensor, 8);
  std::vector<int> timestamps(2500, 700);
  timestamps.insert(timestamps.end(), 2500, 200);
  // A step of the wave is 37 codes wide.
  EXPECT_NEAR(rival->decode(read_one_frame(*rival, one_each(timestamps))).position, 200.0, 20.0);
}

// What leaks is exactly the average, however small: the fixed point of a mean of 1/8 is 1/8 of 2^shift.
TEST(TwoCorrelations, SmallAveragesLeakToo) {
  SensorModel sensor = of_np(4);
  sensor.acquisitions = 40'000;
  constexpr int kShift = 10;
  const std::unique_ptr<Rival> rival = make_two_correlations(sensor, kShift);
  // In 16 detections: codes 0 and 8 take each other's place away, and one of code 2 adds its wave.
  std::vector<int> timestamps;
  for (int i = 0; i < 40'000; ++i) {
    timestamps.push_back(i % 16 == 0 ? 2 : i % 2 == 0 ? 8 : 0);
  }
  const std::vector<int> even(timestamps.begin(), timestamps.begin() + 16);
  const RivalWords one =
      read_one_frame(*make_two_correlations(sensor, 24), one_each(even));  // nothing leaks yet
  const RivalWords words = read_one_frame(*rival, one_each(timestamps));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(words[k], std::ldexp(one[k], kShift) / 16.0, 40.0) << k;
  }
}

// Whatever the code, a pulse without noise is where it is, on dark and on bright background.
TEST(CodeMatcher, EveryCodeFindsANoiseFreePulse) {
  SensorModel sensor;
  sensor.acquisitions = 20000;
  struct Case {
    const char* name;
    std::unique_ptr<Rival> rival;
    double tolerance;
  };
  std::vector<Case> cases;
  for (int bits = 1; bits <= 4; ++bits) {
    cases.push_back({"truncated Fourier",
                     make_linear_code(sensor, {.counters = 16,
                                               .weights = wave_weights(10, truncated_fourier(16), bits),
                                               .count_bits = 18,
                                               .is_signed = true}),
                     1.0});
    cases.push_back({"Gray-Fourier",
                     make_linear_code(sensor, {.counters = 8,
                                               .weights = wave_weights(
                                                   10, gray_fourier(8, largest_harmonic(sensor)), bits),
                                               .count_bits = 18,
                                               .is_signed = true}),
                     1.0});
  }
  cases.push_back({"sketch", make_sketch(sensor, 2), 0.5});
  cases.push_back({"spline sketch", make_spline_sketch(sensor, 16, 16), 1.0});
  for (const Case& one : cases) {
    for (const double centre : {90.0, 317.0, 512.5, 800.0}) {
      for (const int floor : {0, 2}) {
        const RivalWords words = read_one_frame(*one.rival, noise_free_pulse(sensor, centre, 2000.0, floor));
        EXPECT_NEAR(one.rival->decode(words).position, centre, one.tolerance) << one.name << " " << floor;
        const std::vector<double> evidence = one.rival->evidence(words);
        EXPECT_NEAR(static_cast<double>(std::ranges::max_element(evidence) - evidence.begin()), centre,
                    one.tolerance + 0.5)
            << one.name;
      }
    }
  }
}

// The histogram is such a code, too: the correlation is that of its counts without their mean.
TEST(CodeMatcher, ZeroMeanOfBins) {
  SensorModel sensor = of_np(6);
  std::vector<std::int16_t> weights;
  for (int x = 0; x < 64; ++x) {
    for (int bin = 0; bin < 7; ++bin) {  // 7 bins of 9 codes; the last code is no detection
      weights.push_back(static_cast<std::int16_t>(x / 9 == bin ? 1 : 0));
    }
  }
  const CodeMatcher matcher(sensor, weights, 7);
  const std::vector<std::int32_t> counts = {5, 5, 9, 20, 8, 5, 4};
  std::vector<std::int32_t> more = counts;
  std::ranges::transform(more, more.begin(), [](int count) { return count + 30; });
  const std::vector<double> rho = matcher.correlation(counts);
  const std::vector<double> same = matcher.correlation(more);
  for (std::size_t t = 0; t < rho.size(); ++t) {
    EXPECT_NEAR(rho[t], same[t], 1e-9) << t;
    EXPECT_LE(std::abs(rho[t]), 1.0 + 1e-12);
  }
  EXPECT_THAT(matcher.correlation(std::vector<std::int32_t>(7, 30)), Each(0.0));
}

TEST(CodeMatcher, EvidenceIsTheLikelihoodRatioOfACorrelation) {
  const SensorModel sensor;
  const std::vector<std::int16_t> weights = wave_weights(10, truncated_fourier(4), 4);
  const CodeMatcher matcher(sensor, weights, 4);
  const std::vector<std::int32_t> words = {30, -12, 5, 22};
  const std::vector<double> rho = matcher.correlation(words);
  const std::vector<double> evidence = matcher.evidence(words);
  for (std::size_t t = 0; t < rho.size(); ++t) {
    const double expected = rho[t] > 0.0 ? -2.0 * std::log(1.0 - rho[t] * rho[t]) : 0.0;
    EXPECT_NEAR(evidence[t], expected, 1e-9);
  }
}

}  // namespace
}  // namespace dtof
