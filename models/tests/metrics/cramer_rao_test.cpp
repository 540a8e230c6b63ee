// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/cramer_rao.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const PulseObservation kThesis{.signal_events = 0.3,
                               .background_events = 0.15,
                               .centre_bins = 400.0,
                               .sigma_bins = 19.3,
                               .np = 10,
                               .acquisitions = 3333,
                               .kept_events = 2};

PulseObservation thesis_with(void (*change)(PulseObservation&)) {
  PulseObservation observation = kThesis;
  change(observation);
  return observation;
}

void expect_relative(double actual, double expected, double tolerance) {
  EXPECT_NEAR(actual / expected, 1.0, tolerance) << actual << " instead of " << expected;
}

TEST(CramerRao, WithoutBackgroundSigmaOverRootSignal) {
  for (const double events : {1e-12, 1e-3, 0.3, 1e6}) {
    PulseObservation observation = kThesis;
    observation.signal_events = events;
    observation.background_events = 0.0;
    observation.kept_events = 0;
    expect_relative(cramer_rao_bound(observation), 19.3 / std::sqrt(events * 3333), 1e-3);
  }
}

TEST(CramerRao, BackgroundLimited) {
  PulseObservation observation = kThesis;
  observation.signal_events = 1e-4;
  observation.background_events = 100.0;
  observation.kept_events = 0;
  observation.acquisitions = 1e4;
  const double signal = 1e-4 * 1e4;
  const double background_per_bin = 100.0 / 1024.0 * 1e4;
  const double expected =
      std::sqrt(4.0 * std::sqrt(std::numbers::pi) * std::pow(19.3, 3) * background_per_bin) / signal;
  expect_relative(cramer_rao_bound(observation), expected, 1e-3);
}

TEST(CramerRao, FallsWithTheRootOfAcquisitions) {
  PulseObservation longer = kThesis;
  longer.acquisitions *= 4;
  expect_relative(cramer_rao_bound(longer), cramer_rao_bound(kThesis) / 2, 1e-12);
}

// The bound of one kept event from the exact first-photon probabilities p_i = (1 - e^-lambda_i) e^-Lambda_i,
// differentiated numerically.
double first_photon_bound(const PulseObservation& observation) {
  const auto probabilities = [&observation](double centre) {
    const int code_count = 1 << observation.np;
    std::vector<double> p;
    double earlier = 0.0;
    for (int bin = 0; bin + 1 < code_count; ++bin) {
      const auto cdf = [&](double edge) {
        return 0.5 * std::erfc((centre - edge) / observation.sigma_bins / std::numbers::sqrt2);
      };
      const double rate =
          observation.signal_events * (cdf(bin + 1) - cdf(bin)) + observation.background_events / code_count;
      p.push_back(-std::expm1(-rate) * std::exp(-earlier));
      earlier += rate;
    }
    return p;
  };
  const double h = 1e-3;
  const std::vector<double> p = probabilities(observation.centre_bins);
  const std::vector<double> left = probabilities(observation.centre_bins - h);
  const std::vector<double> right = probabilities(observation.centre_bins + h);
  double information = 0.0;
  double none = 1.0;
  double none_slope = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double slope = (right[i] - left[i]) / (2 * h);
    information += slope * slope / p[i];
    none -= p[i];
    none_slope -= slope;
  }
  information += none_slope * none_slope / none;
  return 1.0 / std::sqrt(information * observation.acquisitions);
}

TEST(CramerRao, FirstPhotonAgainstExactProbabilities) {
  for (const double signal : {0.03, 0.3, 3.0, 20.0}) {
    for (const double background : {0.05, 0.5, 3.0}) {
      PulseObservation observation = kThesis;
      observation.signal_events = signal;
      observation.background_events = background;
      observation.kept_events = 1;
      expect_relative(cramer_rao_bound(observation), first_photon_bound(observation), 1e-3);
    }
  }
}

TEST(CramerRao, KeepingMoreEventsNeverHurtsAndTendsToAll) {
  PulseObservation observation = kThesis;
  observation.signal_events = 3.0;
  observation.background_events = 3.0;
  double previous = std::numeric_limits<double>::infinity();
  for (int kept = 1; kept <= 16; ++kept) {
    observation.kept_events = kept;
    const double bound = cramer_rao_bound(observation);
    EXPECT_LE(bound, previous) << kept;
    previous = bound;
  }
  observation.kept_events = 0;
  expect_relative(previous, cramer_rao_bound(observation), 1e-3);
  EXPECT_LE(cramer_rao_bound(observation), previous);
}

TEST(CramerRao, PileUpWeightIsSmoothWhereItsFormulaChanges) {
  PulseObservation below = kThesis;
  below.signal_events = 1e-7;
  below.kept_events = 1;
  PulseObservation above = below;
  below.background_events = 0.9999e-5 * 1024;
  above.background_events = 1.0001e-5 * 1024;
  expect_relative(cramer_rao_bound(below), cramer_rao_bound(above), 2e-4);
}

TEST(CramerRao, LastBinIsNoDetectionAndHasNoInformation) {
  // One bin left, [0, 1), and half of the pulse's one sigma in it: rate Phi(0) - Phi(-1), slope phi(-1) -
  // phi(0).
  const PulseObservation one_bin{.signal_events = 1.0,
                                 .background_events = 0.0,
                                 .centre_bins = 1.0,
                                 .sigma_bins = 1.0,
                                 .np = 1,
                                 .acquisitions = 1.0,
                                 .kept_events = 0};
  expect_relative(cramer_rao_bound(one_bin), std::sqrt(0.3413447460685429) / 0.1569715556, 1e-8);
}

TEST(CramerRao, TailsOfPulsesOutsideTheRangeDoNotCancel) {
  for (const double sigmas : {0.5, 4.0, 8.0, 20.0}) {
    PulseObservation before = kThesis;
    before.background_events = 0.0;
    before.kept_events = 0;
    before.centre_bins = -sigmas * before.sigma_bins;
    PulseObservation behind = before;
    behind.centre_bins = 1023.0 - before.centre_bins;  // the mirror image
    expect_relative(cramer_rao_bound(before), cramer_rao_bound(behind), 1e-9);
  }
}

TEST(CramerRao, NothingToLearnIsInfinite) {
  EXPECT_TRUE(std::isinf(cramer_rao_bound(thesis_with([](PulseObservation& o) { o.signal_events = 0.0; }))));
  EXPECT_TRUE(std::isinf(cramer_rao_bound(thesis_with([](PulseObservation& o) { o.acquisitions = 0.0; }))));
  EXPECT_TRUE(std::isinf(cramer_rao_bound(thesis_with([](PulseObservation& o) { o.centre_bins = 1e6; }))));
  EXPECT_TRUE(std::isinf(cramer_rao_bound(thesis_with([](PulseObservation& o) {
    o.signal_events = 0.0;
    o.background_events = 0.0;
  }))));
}

TEST(CramerRao, NeverNaN) {
  for (const double signal : {0.0, 1e-300, 1e-12, 1.0, 1e3, 1e6}) {
    for (const double background : {0.0, 1e-300, 1e-12, 1.0, 1e6}) {
      for (const double sigma : {1e-6, 0.04, 1.0, 435.0, 1e6}) {
        for (const double centre : {-1e4, -10.0, 0.0, 0.5, 500.0, 1023.0, 1e4}) {
          for (const int kept : {0, 1, 2, 16}) {
            const double bound = cramer_rao_bound({signal, background, centre, sigma, 10, 3333, kept});
            ASSERT_FALSE(std::isnan(bound)) << signal << ' ' << background << ' ' << sigma << ' ' << centre;
            ASSERT_GE(bound, 0.0);
          }
        }
      }
    }
  }
}

TEST(CramerRao, RefusesImpossibleValues) {
  const auto refuses = [](void (*change)(PulseObservation&), const char* message) {
    EXPECT_THAT([=] { cramer_rao_bound(thesis_with(change)); },
                ThrowsMessage<InputError>(HasSubstr(message)));
  };
  refuses([](PulseObservation& o) { o.signal_events = -1; }, "number of signal events is -1");
  refuses([](PulseObservation& o) { o.signal_events = NAN; }, "number of signal events is nan");
  refuses([](PulseObservation& o) { o.background_events = -1; }, "number of background events is -1");
  refuses([](PulseObservation& o) { o.centre_bins = NAN; }, "pulse centre is nan");
  refuses([](PulseObservation& o) { o.sigma_bins = 0; }, "pulse sigma is 0");
  refuses([](PulseObservation& o) { o.np = 0; }, "NP is 0");
  refuses([](PulseObservation& o) { o.acquisitions = -1; }, "number of acquisitions is -1");
  refuses([](PulseObservation& o) { o.kept_events = 17; }, "number of kept events is 17");
}

// Samples of a Gaussian of this standard deviation, on bins a quarter as wide.
std::shared_ptr<const PulseResponse> sampled_gaussian(double sigma_bins) {
  constexpr double kBin = 0.25;
  std::vector<double> samples;
  for (double time = -6.0 * sigma_bins; time < 6.0 * sigma_bins; time += kBin) {
    const double middle = (time + 0.5 * kBin) / sigma_bins;
    samples.push_back(std::exp(-0.5 * middle * middle));
  }
  return std::make_shared<const PulseResponse>(std::move(samples), kBin);
}

TEST(CramerRao, SampledGaussianHasTheGaussiansBound) {
  for (const double sigma : {6.0, 19.3}) {
    for (const int kept : {0, 1, 2}) {
      PulseObservation o{.signal_events = 0.1,
                         .background_events = 0.15,
                         .centre_bins = 300.3,
                         .sigma_bins = sigma,
                         .np = 10,
                         .acquisitions = 1000.0,
                         .kept_events = kept};
      const double gaussian = cramer_rao_bound(o);
      o.response = sampled_gaussian(sigma);
      // The slope over one bin falls short by 1 / (8 sigma^2), more or less.
      EXPECT_NEAR(cramer_rao_bound(o) / gaussian, 1.0, 0.3 / (sigma * sigma)) << sigma << ' ' << kept;
      // A pulse of half the width is told apart.
      o.response = sampled_gaussian(0.5 * sigma);
      EXPECT_LT(cramer_rao_bound(o), 0.8 * gaussian);
    }
  }
}

TEST(CramerRao, MeasuredPulseOfOneBoxHasItsInformationInTheEdges) {
  // A box of 8 bins at whole bins on background b: each of the four bins that a shift by half a bin touches
  // has |slope| S / 16; two have the rate b + S / 8, two have b.
  PulseObservation o{.signal_events = 0.8,
                     .background_events = 1024.0 * 0.05,
                     .centre_bins = 100.0,
                     .sigma_bins = 1.0,
                     .np = 10,
                     .acquisitions = 100.0,
                     .kept_events = 0,
                     .response = std::make_shared<const PulseResponse>(std::vector<double>(8, 1.0), 1.0)};
  const double information = 100.0 * 2.0 * (0.05 * 0.05 / 0.15 + 0.05 * 0.05 / 0.05);
  EXPECT_NEAR(cramer_rao_bound(o), 1.0 / std::sqrt(information), 1e-9);
}

}  // namespace
}  // namespace dtof
