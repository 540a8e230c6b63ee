// SPDX-License-Identifier: Apache-2.0
// Each effect of a real sensor against a closed form. Seeds are fixed (DTOF_TEST_SEED changes them); a right
// model fails one test in a million (kErrorRate).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/photon/statistics.hpp"

namespace dtof {
namespace {

constexpr std::uint32_t kAcquisitions = 4000;
constexpr int kColumns = 4;
constexpr int kRows = 50;

class SensorEffects : public ::testing::Test {
 protected:
  SensorEffects() {
    sensor_.acquisitions = kAcquisitions;
    sensor_.slots = 16;
  }

  [[nodiscard]] PhotonSource source(double depth_m, double klux, std::uint32_t frame = 0) const {
    return {sensor_, TargetMap(kColumns, kRows, {.depth_m = depth_m, .reflectivity = 1.0}), klux, test_seed(),
            frame};
  }

  /// Detections of every code, of all pixels.
  template <typename Source>
  [[nodiscard]] std::vector<std::uint64_t> counts(const Source& source) const {
    std::vector<std::uint64_t> codes(std::size_t{1} << static_cast<unsigned>(sensor_.np));
    for (int column = 0; column < source.columns(); ++column) {
      const ColumnStream stream = source.column(column);
      for (int row = 0; row < stream.rows(); ++row) {
        for (const Detection& detection : stream.row(row)) {
          ++codes.at(detection.timestamp);
        }
      }
    }
    return codes;
  }

  [[nodiscard]] static std::vector<double> times_acquisitions(std::vector<double> means) {
    for (double& mean : means) {
      mean *= 1.0 * kAcquisitions * kColumns * kRows;
    }
    return means;
  }

  SensorModel sensor_;
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

// Two boxes: 2 ns with a quarter of the pulse, and 1 ns later 0.5 ns with the rest.
PulseResponse two_boxes() { return {{1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 12.0}, 0.5e-9}; }

/// Mean events per code of that pulse, from its description above.
std::vector<double> two_box_means(const SensorModel& sensor, const PixelRates& rates) {
  const double ns = 1e-9 / sensor.time_resolution_s();
  const double centroid = 0.25 * 1.0 * ns + 0.75 * 3.25 * ns;
  const double first = rates.centre_bins - centroid;
  const auto box_before = [](double t, double begin, double width) {
    return std::clamp((t - begin) / width, 0.0, 1.0);
  };
  const auto before = [&](double t) {
    return 0.25 * box_before(t, first, 2.0 * ns) + 0.75 * box_before(t, first + 3.0 * ns, 0.5 * ns);
  };
  std::vector<double> means;
  const double codes = std::ldexp(1.0, sensor.np);
  for (double code = 0.0; code < codes; code += 1.0) {
    means.push_back(rates.background / codes + rates.signal * (before(code + 1.0) - before(code)));
  }
  return means;
}

TEST_F(SensorEffects, MeasuredPulseHasTheTimesOfItsBoxes) {
  sensor_.pulse_response = std::make_shared<const PulseResponse>(two_boxes());
  const PhotonSource exact = source(1.0, 14.0);
  const std::vector<double> means = two_box_means(sensor_, exact.rates(0, 0));
  EXPECT_GT(poisson_chi_square_p(counts(exact), times_acquisitions(means)), kErrorRate);
  // The same test rejects the Gaussian.
  sensor_.pulse_response = nullptr;
  EXPECT_LT(poisson_chi_square_p(counts(source(1.0, 14.0)), times_acquisitions(means)), kErrorRate);
}

TEST_F(SensorEffects, MeasuredPulsePilesUpAsExpected) {
  // Near: events are drawn in time order, slot by slot.
  sensor_.pulse_response = std::make_shared<const PulseResponse>(two_boxes());
  sensor_.slots = 2;
  for (const double depth : {0.15, 0.5}) {
    const PhotonSource exact = source(depth, 14.0);
    EXPECT_GT(chi_square_p(counts(exact), expected_detections(sensor_, exact.rates(0, 0)),
                           1.0 * kAcquisitions * kColumns * kRows),
              kErrorRate)
        << depth;
  }
}

TEST_F(SensorEffects, ExpectedDetectionsOfAMeasuredPulseAreThoseOfItsBoxes) {
  sensor_.pulse_response = std::make_shared<const PulseResponse>(two_boxes());
  sensor_.signal_events_1m = 1e-4;
  sensor_.dark_count_rate_hz = 0.0;
  const PixelRates rates = source(1.0, 0.0).rates(0, 0);
  const std::vector<double> means = two_box_means(sensor_, rates);
  const std::vector<double> expected = expected_detections(sensor_, rates);
  for (std::size_t code = 0; code < means.size(); ++code) {
    EXPECT_NEAR(expected[code], means[code], 1e-9) << code;
  }
}

TEST_F(SensorEffects, JitterAddsToTheWidthInQuadrature) {
  sensor_.jitter_fwhm_s = 1.5e-9;
  const double sigma = pulse_sigma_s(std::hypot(2e-9, 1.5e-9)) / sensor_.time_resolution_s();
  const PhotonSource exact = source(2.0, 2.0);
  const PixelRates rates = exact.rates(0, 0);
  const std::vector<double> means = times_acquisitions(
      bin_means(std::size_t{1} << 10U, rates.background, rates.signal, rates.centre_bins, sigma));
  EXPECT_GT(poisson_chi_square_p(counts(exact), means), kErrorRate);
  EXPECT_GT(poisson_chi_square_p(counts(FastPhotonSource(exact)), means), kErrorRate);
  // A short measured pulse with the jitter of both is the same Gaussian.
  sensor_.pulse_response = std::make_shared<const PulseResponse>(std::vector<double>{1.0}, 1e-12);
  sensor_.jitter_fwhm_s = std::hypot(2e-9, 1.5e-9);
  EXPECT_GT(poisson_chi_square_p(counts(source(2.0, 2.0)), means), kErrorRate);
  sensor_.jitter_fwhm_s = 2e-9;
  EXPECT_LT(poisson_chi_square_p(counts(source(2.0, 2.0)), means), kErrorRate);
}

TEST_F(SensorEffects, AfterpulsesRaiseTheRateAsTheBranchingProcessSays) {
  // Background alone from time 0 on: the rate m(t) = b (1 + p / (1 - p) (1 - exp(-(1 - p) t / tau))) solves
  // m(t) = b + p * integral of m(s) exp(-(t - s) / tau) / tau.
  constexpr double kProbability = 0.2;
  sensor_.afterpulse_probability = kProbability;
  sensor_.afterpulse_time_constant_s = 4e-9;
  const PhotonSource exact = source(0.0, 14.0);
  const double background = exact.rates(0, 0).background;
  const double tau = 4e-9 / sensor_.time_resolution_s();
  const double rise = (1.0 - kProbability) / tau;
  const double codes = std::ldexp(1.0, sensor_.np);
  const auto before = [&](double t) {
    return background / codes *
           (t + kProbability / (1.0 - kProbability) * (t + std::expm1(-rise * t) / rise));
  };
  std::vector<double> means;
  for (double code = 0.0; code < codes; code += 1.0) {
    means.push_back(before(code + 1.0) - before(code));
  }
  EXPECT_GT(poisson_chi_square_p(counts(exact), times_acquisitions(means)), kErrorRate);
  sensor_.afterpulse_probability = 0.0;
  EXPECT_LT(poisson_chi_square_p(counts(source(0.0, 14.0)), times_acquisitions(means)), kErrorRate);
}

TEST_F(SensorEffects, AfterpulsesOfDenseLightFollowOnce) {
  // So much light that events are drawn in time order; all are kept.
  constexpr double kProbability = 0.2;
  sensor_.slots = 1000;
  sensor_.acquisitions = 50;
  sensor_.afterpulse_probability = kProbability;
  sensor_.afterpulse_time_constant_s = 1e-9;
  const PhotonSource exact = source(0.0, 3000.0);
  const double codes = std::ldexp(1.0, sensor_.np);
  const double rise = (1.0 - kProbability) * sensor_.time_resolution_s() / 1e-9;
  const double mean =
      exact.rates(0, 0).background *
      (1.0 + kProbability / (1.0 - kProbability) * (1.0 + std::expm1(-rise * codes) / (rise * codes)));
  const std::vector<std::uint64_t> all = counts(exact);
  const auto total = static_cast<double>(std::accumulate(all.begin(), all.end(), std::uint64_t{0}));
  EXPECT_NEAR(total / (50.0 * kColumns * kRows), mean, 0.01 * mean);
}

TEST_F(SensorEffects, SecondEventsFollowAtTheTimeOfPhotonOrAfterpulse) {
  // After an event at time t nothing comes before t + D. Of the rest, no photon and no afterpulse within x:
  // exp(-b x) (1 - p + p exp(-x / tau)). The dense light makes the sampler draw in time order.
  constexpr double kProbability = 0.3;
  sensor_.slots = 2;
  sensor_.afterpulse_probability = kProbability;
  for (const double klux : {0.5, 3000.0}) {
    sensor_.afterpulse_time_constant_s = klux > 1.0 ? 1e-9 : 3e-9;
    sensor_.dead_time_s = 2e-9;
    const PhotonSource exact = source(0.0, klux);
    const double bin_s = sensor_.time_resolution_s();
    const double per_bin = exact.rates(0, 0).background / std::ldexp(1.0, sensor_.np);
    const double tau = sensor_.afterpulse_time_constant_s / bin_s;
    const double dead = sensor_.dead_time_s / bin_s;
    const auto still = [&](double x) {
      return std::exp(-per_bin * x) * (1.0 - kProbability + kProbability * std::exp(-x / tau));
    };
    // From first codes in the range's first half, up to 20 ns later, in bins; times are known to a bin, so
    // the probability of the second one within k bins is that of the difference of two uniform roundings: the
    // integral of the survival over a bin.
    constexpr int kLag = 455;
    std::vector<std::uint64_t> lags(kLag);
    double firsts = 0.0;
    for (int column = 0; column < kColumns; ++column) {
      const ColumnStream stream = exact.column(column);
      for (int row = 0; row < kRows; ++row) {
        const auto detections = stream.row(row);
        for (std::size_t i = 0; i < detections.size(); ++i) {
          const bool first = i == 0 || detections[i - 1].acquisition != detections[i].acquisition;
          if (!first || detections[i].timestamp > 512) {
            continue;
          }
          firsts += 1.0;
          const bool followed =
              i + 1 < detections.size() && detections[i + 1].acquisition == detections[i].acquisition;
          const int lag = followed ? detections[i + 1].timestamp - detections[i].timestamp : kLag;
          if (lag < kLag) {
            ++lags[static_cast<std::size_t>(lag)];
          }
        }
      }
    }
    std::vector<double> shares;
    constexpr int kSteps = 64;  // of the first event's place in its bin
    for (int lag = 0; lag < kLag; ++lag) {
      double share = 0.0;
      for (int step = 0; step < kSteps; ++step) {
        const double place = (step + 0.5) / kSteps;
        const double from = std::max(lag - place - dead, 0.0);
        const double to = std::max(lag + 1.0 - place - dead, 0.0);
        share += (still(from) - still(to)) / kSteps;
      }
      shares.push_back(share);
    }
    EXPECT_GT(chi_square_p(lags, shares, firsts), kErrorRate) << klux;
  }
}

TEST_F(SensorEffects, AfterpulsesStopAtTheGateAndTheAcquisition) {
  sensor_.afterpulse_probability = 0.9;
  sensor_.afterpulse_time_constant_s = 30e-9;
  sensor_.time_gate = TimeGate{10e-9, 20e-9};
  const double bin_s = sensor_.time_resolution_s();
  for (const double klux : {14.0, 20000.0}) {
    const std::vector<std::uint64_t> codes = counts(source(0.0, klux));
    for (std::size_t code = 0; code < codes.size(); ++code) {
      const auto time = static_cast<double>(code) * bin_s;
      if (time + bin_s <= 10e-9 || time >= 20e-9) {
        EXPECT_EQ(codes[code], 0U) << code;
      }
    }
  }
}

TEST_F(SensorEffects, HotAndDeadPixelsAreASharedFixedSet) {
  sensor_.defects = {
      .hot_share = 0.3, .dead_share = 0.2, .hot = {{1, 2}}, .dead = {{0, 0}}, .hot_dark_count_rate_hz = 2e6};
  EXPECT_TRUE(sensor_.defects.is_dead(0, 0));
  EXPECT_TRUE(sensor_.defects.is_hot(1, 2) || sensor_.defects.is_dead(1, 2));
  double hot = 0.0;
  double dead = 0.0;
  constexpr int kSide = 200;
  for (int column = 0; column < kSide; ++column) {
    for (int row = 0; row < kSide; ++row) {
      hot += sensor_.defects.is_hot(column, row) ? 1.0 : 0.0;
      dead += sensor_.defects.is_dead(column, row) ? 1.0 : 0.0;
      EXPECT_FALSE(sensor_.defects.is_hot(column, row) && sensor_.defects.is_dead(column, row));
    }
  }
  EXPECT_GT(binomial_p(hot, kSide * kSide, 0.3), kErrorRate);
  EXPECT_GT(binomial_p(dead, kSide * kSide, 0.2), kErrorRate);

  const PhotonSource exact = source(2.0, 14.0);
  const PhotonSource later = exact.at_frame(7);
  const double clean = sensor_.background_events(14.0, 1.0);
  for (int column = 0; column < kColumns; ++column) {
    const ColumnStream stream = exact.column(column);
    const ColumnStream fast = FastPhotonSource(exact).column(column);
    for (int row = 0; row < kRows; ++row) {
      const PixelRates rates = exact.rates(column, row);
      const double expected =
          sensor_.defects.is_hot(column, row) ? clean + (2e6 - 1e4) * sensor_.integration_time_s : clean;
      if (sensor_.defects.is_dead(column, row)) {
        EXPECT_EQ(rates.background + rates.signal, 0.0);
        EXPECT_TRUE(stream.row(row).empty());
        EXPECT_TRUE(fast.row(row).empty());
      } else {
        EXPECT_DOUBLE_EQ(rates.background, expected);
        const double mean = kAcquisitions * (rates.background + rates.signal);
        EXPECT_GT(normal_p(static_cast<double>(stream.row(row).size()) - mean, std::sqrt(mean)), kErrorRate);
      }
      EXPECT_EQ(rates.background, later.rates(column, row).background);
    }
  }
  const PixelDefects other{
      .hot_share = 0.3, .dead_share = 0.2, .hot = {}, .dead = {}, .hot_dark_count_rate_hz = 0.0, .seed = 2};
  int moved = 0;
  for (int row = 0; row < kSide; ++row) {
    moved += other.is_dead(5, row) != sensor_.defects.is_dead(5, row) ? 1 : 0;
  }
  EXPECT_GT(moved, 0);
}

TEST_F(SensorEffects, UnequalCodesGetTheLightOfTheirWidths) {
  sensor_.tdc_codes =
      std::make_shared<const TdcCodes>(std::vector<std::vector<double>>{{3.0, 1.0, 0.0, 4.0}});
  const PhotonSource exact = source(0.0, 14.0);
  const double background = exact.rates(0, 0).background;
  std::vector<double> means;
  constexpr std::array kWidths = {1.5, 0.5, 0.0, 2.0};
  for (std::size_t code = 0; code < 1024; ++code) {
    means.push_back(background / 1024.0 * kWidths.at(code % 4));
  }
  const std::vector<std::uint64_t> codes = counts(exact);
  EXPECT_GT(poisson_chi_square_p(codes, times_acquisitions(means)), kErrorRate);
  for (std::size_t code = 2; code < codes.size(); code += 4) {
    EXPECT_EQ(codes[code], 0U);
  }
  // With signal and pile-up, against the closed form.
  sensor_.slots = 2;
  for (const double depth : {0.15, 1.0}) {
    const PhotonSource lit = source(depth, 14.0);
    EXPECT_GT(chi_square_p(counts(lit), expected_detections(sensor_, lit.rates(0, 0)),
                           1.0 * kAcquisitions * kColumns * kRows),
              kErrorRate)
        << depth;
  }
}

TEST_F(SensorEffects, EqualWidthsChangeNothingAndPixelsHaveTheirOwnTdc) {
  const PhotonSource plain = source(1.0, 14.0);
  sensor_.tdc_codes = std::make_shared<const TdcCodes>(std::vector<std::vector<double>>{{5.0}, {5.0, 0.0}});
  const PhotonSource unequal = source(1.0, 14.0);
  for (int column = 0; column < kColumns; ++column) {
    const ColumnStream a = plain.column(column);
    const ColumnStream b = unequal.column(column);
    for (int row = 0; row < kRows; ++row) {
      // Pixel row * 4 + column: even columns have the first table. Widths 5, 0 (the last is cut off): equal,
      // too.
      ASSERT_TRUE(std::ranges::equal(a.row(row), b.row(row)));
    }
  }
  sensor_.tdc_codes = std::make_shared<const TdcCodes>(std::vector<std::vector<double>>{{1.0}, {1.0, 3.0}});
  const PhotonSource alternating = source(1.0, 14.0);
  for (int column = 0; column < kColumns; ++column) {
    EXPECT_EQ(std::ranges::equal(plain.column(column).row(0), alternating.column(column).row(0)),
              column % 2 == 0);
  }
}

TEST_F(SensorEffects, EveryPixelOfAColumnHasItsOwnTable) {
  const std::vector<std::vector<double>> tables = {{1.0}, {1.0, 3.0}, {5.0, 1.0, 1.0}};
  const auto column_with = [&](std::vector<std::vector<double>> chosen) {
    sensor_.tdc_codes = std::make_shared<const TdcCodes>(std::move(chosen));
    return PhotonSource(sensor_, TargetMap(1, 6, {.depth_m = 1.0, .reflectivity = 1.0}), 14.0, test_seed())
        .column(0);
  };
  const ColumnStream all = column_with(tables);
  for (int row = 0; row < all.rows(); ++row) {
    const ColumnStream own = column_with({tables[static_cast<std::size_t>(row) % tables.size()]});
    EXPECT_TRUE(std::ranges::equal(all.row(row), own.row(row))) << row;
  }
  // Closed forms, which know no pixel, take the first table.
  sensor_.tdc_codes = std::make_shared<const TdcCodes>(tables);
  const std::vector<double> first = expected_detections(sensor_, {.background = 0.1, .signal = 0.0});
  EXPECT_NEAR(first[0] / first[1], 1.0, 1e-3);
}

TEST_F(SensorEffects, SomeRowsAreThoseOfTheWholeColumn) {
  sensor_.pulse_response = std::make_shared<const PulseResponse>(two_boxes());
  sensor_.jitter_fwhm_s = 0.1e-9;
  sensor_.afterpulse_probability = 0.1;
  sensor_.afterpulse_time_constant_s = 5e-9;
  sensor_.dead_time_s = 3e-9;
  sensor_.defects = {
      .hot_share = 0.1, .dead_share = 0.1, .hot = {}, .dead = {}, .hot_dark_count_rate_hz = 1e6};
  sensor_.tdc_codes =
      std::make_shared<const TdcCodes>(std::vector<std::vector<double>>{{1.0, 2.0}, {2.0, 1.0}, {1.0}});
  const PhotonSource exact = source(1.0, 14.0);
  const ColumnStream whole = exact.column(2);
  const ColumnStream part = exact.column_rows(2, {7, 5});
  for (int row = 0; row < 5; ++row) {
    EXPECT_TRUE(std::ranges::equal(whole.row(7 + row), part.row(row)));
  }
}

TEST_F(SensorEffects, FasterModelsRefuseWhatTheyLack) {
  const auto refused = [&] {
    EXPECT_FALSE(FastPhotonSource::supports(sensor_));
    EXPECT_THROW(FastPhotonSource{source(1.0, 14.0)}, InputError);
    EXPECT_THROW(MeanPhotonSource{source(1.0, 14.0)}, InputError);
  };
  const SensorModel clean = sensor_;
  sensor_.pulse_response = std::make_shared<const PulseResponse>(two_boxes());
  refused();
  sensor_ = clean;
  sensor_.tdc_codes = std::make_shared<const TdcCodes>(std::vector<std::vector<double>>{{1.0}});
  refused();
  sensor_ = clean;
  sensor_.afterpulse_probability = 0.1;
  sensor_.afterpulse_time_constant_s = 1e-9;
  refused();
  EXPECT_THROW(expected_detections(sensor_, {}), InputError);
}

TEST(SensorModelEffects, RefusesImpossibleEffects) {
  const auto refused = [](auto set) {
    SensorModel sensor;
    set(sensor);
    EXPECT_THROW(sensor.validate(), InputError);
  };
  refused([](SensorModel& s) { s.jitter_fwhm_s = -1.0; });
  refused([](SensorModel& s) { s.afterpulse_probability = 0.95; });
  refused([](SensorModel& s) { s.afterpulse_probability = std::nan(""); });
  refused([](SensorModel& s) { s.afterpulse_probability = 0.1; });  // no time constant
  refused([](SensorModel& s) { s.defects.hot_share = 0.6, s.defects.dead_share = 0.5; });
  refused([](SensorModel& s) { s.defects.dead_share = std::nan(""); });
  refused([](SensorModel& s) { s.defects.hot_dark_count_rate_hz = -1.0; });
}

}  // namespace
}  // namespace dtof
