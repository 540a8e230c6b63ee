// SPDX-License-Identifier: Apache-2.0
// Metrics, read-outs and tables: largest errors over extreme inputs, against 50-digit arithmetic, closed
// forms or exact integers. photon_stability_test has the photon models.
#include "tests/analytic/stability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "dtof/analytic/code_distribution.hpp"
#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/metrics/cramer_rao.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/metrics/lookup_table.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/readout/histogram.hpp"

namespace dtof {
namespace {

std::vector<StabilityResult> check_statistics() {
  Largest sums;
  for (const double value : {0.1, 1.0, 5.0, 77.7, 1023.0}) {
    const double other = value + 1.0;
    RunningMoments moments;
    moments.add(value);
    moments.add(other);
    for (int i = 0; i < 30; ++i) {
      const RunningMoments copy = moments;
      moments.merge(copy);
    }
    const Real n = pow(Real(2), 31);
    const Real difference = Real(other) - Real(value);
    sums.relative(moments.mean(), (Real(value) + Real(other)) / 2);
    sums.relative(moments.variance(), difference * difference * n / 4 / (n - 1));
    sums.add(moments.count() == (std::uint64_t{1} << 31) ? 0.0 : kInfinity);
  }
  Largest close;
  Largest negative;
  for (const double offset : {5.0, 1e6, 1e9}) {
    for (const double step : {0.0, 1e-9, 1e-3, 1.0}) {
      RunningMoments moments;
      Real sum = 0;
      Real square = 0;
      constexpr int kValues = 1001;
      for (int i = 0; i < kValues; ++i) {
        const double value = offset + step * (i % 7);
        moments.add(value);
        sum += Real(value);
        square += Real(value) * Real(value);
      }
      const Real variance = (square - sum * sum / kValues) / (kValues - 1);
      negative.add(moments.variance() >= 0.0 ? 0.0 : 1.0);
      // A mean is no finer than a unit in the last place of the values.
      const double last_place = std::nextafter(offset, kInfinity) - offset;
      close.add(static_cast<double>(abs(sqrt(Real(moments.variance())) - sqrt(variance))) / last_place);
    }
  }
  return {sums.row("mean and variance of 2.1e9 values", "values 0.1 to 1024, merged", "closed form", 1e-15),
          close.row("standard deviation of nearly equal numbers",
                    "5, 1e6, 1e9 plus 0 to 6 steps of 0, 1e-9, 1e-3, 1", "50 digits", 1.0,
                    "last places of the values"),
          negative.row("variance is not negative", "the same", "0", 0.0, "violations")};
}

std::vector<StabilityResult> check_peaks() {
  Largest ties;
  Largest saturation;
  for (int width = 1; width <= 16; ++width) {
    const std::uint32_t limit = (1U << static_cast<unsigned>(width)) - 1;
    for (std::uint32_t first = 0; first < 16; first += 5) {
      Histogram histogram(4, width, FullBin::kStays);
      // Descending order of bins, so that the first touched is not the lowest.
      for (std::uint32_t bin = 16; bin-- > first;) {
        histogram.add(bin);
      }
      ties.add(histogram.take_peak().bin == first ? 0.0 : 1.0);
      for (std::uint32_t i = 0; i < 2 * limit + 3; ++i) {
        histogram.add(9);
      }
      histogram.add(3);
      const HistogramPeak peak = histogram.take_peak();
      const bool tie = limit == 1;
      saturation.add(peak.count == limit && peak.bin == (tie ? 3U : 9U) && peak.sum == limit + 1 ? 0.0 : 1.0);
    }
  }
  Largest sums;
  Largest values;
  for (const unsigned limit : {1U, 15U, 1023U, 65535U}) {
    for (const double mean : {0.0, 1e-12, 1e-3, 1.0, 700.0, 1023.0, 5e4, 1e6}) {
      for (const double ratio : {0.0, 1e-6, 0.5, 1.0}) {
        std::vector<double> means(32, mean * ratio);
        means[20] = mean;
        for (const FullBin full : {FullBin::kStays, FullBin::kFreezes}) {
          const std::vector<double> share = peak_distribution(means, limit, full);
          sums.add(std::abs(std::accumulate(share.begin(), share.end(), 0.0) - 1.0));
        }
      }
    }
  }
  // Two bins, counts up to 60: every pair summed in 50 digits.
  for (const double a : {1e-12, 0.1, 3.0}) {
    for (const double b : {1e-9, 0.5, 4.0}) {
      Real first = 0;
      Real p = exp(-Real(a));
      for (int n = 0; n < 60; ++n) {
        first += p * (1 - exact_at_least(n + 1, Real(b)));
        p *= Real(a) / (n + 1);
      }
      const std::vector<double> share = peak_distribution({a, b}, 1023, FullBin::kFreezes);
      values.add(share[0], first, Real(1));
      values.add(share[1], 1 - first, Real(1));
    }
  }
  return {
      ties.row("peak of a tie", "16 bins, COUNT_WIDTH 1 to 16", "lowest index, exact", 0.0, "wrong peaks"),
      saturation.row("saturated counters", "COUNT_WIDTH 1 to 16, twice the limit counted", "limit, exact",
                     0.0, "wrong peaks"),
      sums.row("distribution of the peak, sum", "32 bins, means 0 to 1e6, limits 1 to 65,535", "1", 1e-9,
               "absolute"),
      values.row("distribution of the peak, values", "2 bins, means 1e-12 to 4", "50 digits", 4e-15,
                 "absolute")};
}

StabilityResult check_distributions() {
  Largest largest;
  for (const int np : {4, 7, 10}) {
    for (const Readout readout : kThesisReadouts) {
      const ReadoutParameters parameters = ReadoutParameters::defaults(readout, np);
      for (const double signal : {0.0, 1e-9, 0.03, 480.0}) {
        for (const double background : {0.0, 1e-12, 2.1}) {
          SensorModel sensor;
          sensor.np = np;
          sensor.acquisitions = 101;
          const double centre = std::ldexp(0.31, np);
          const auto share = code_distribution(sensor, {background, signal, centre}, parameters);
          const double least = *std::ranges::min_element(share);
          const PredictedErrors errors = predict_errors(share, sensor, parameters, 1.0);
          const bool sane =
              least >= 0.0 && errors.standard_deviation_m >= 0.0 && errors.relative_precision >= 0.0;
          largest.add(sane ? std::abs(std::accumulate(share.begin(), share.end(), 0.0) - 1.0) : kInfinity);
        }
      }
    }
  }
  return largest.row(
      "distribution of a read-out's result: not negative, sum",
      "all read-outs of single pixels, NP 4, 7, 10; 0 to 480 signal, 0 to 2.1 background events", "1", 4e-10,
      "absolute");
}

std::vector<StabilityResult> check_bounds() {
  Largest zero_background;
  Largest zero_signal;
  for (const int np : {4, 8, 10, 14}) {
    for (const double sigma_share : {0.02, 0.05}) {
      for (const double signal : {1e-12, 0.3, 1e6}) {
        const double sigma = std::ldexp(sigma_share, np);
        const PulseObservation observation{.signal_events = signal,
                                           .background_events = 0.0,
                                           .centre_bins = std::ldexp(0.5, np),
                                           .sigma_bins = sigma,
                                           .np = np,
                                           .acquisitions = 3333.0,
                                           .kept_events = 0};
        // The bins' width takes information away: 1/12 bin^2 beside sigma^2 (Sheppard), of next order above.
        const double closed = std::sqrt((sigma * sigma + 1.0 / 12.0) / (signal * 3333.0));
        const double width = 1.0 / sigma;
        zero_background.add(std::abs(cramer_rao_bound(observation) / closed - 1.0) /
                            std::max(std::pow(width, 4), 1e-9));
      }
    }
    for (const double background : {0.0, 1e-12, 0.15, 1e6}) {
      for (const double centre : {-1e6, std::ldexp(0.5, np), 1e9}) {
        const double signal = centre > 0.0 && centre < 1e6 ? 0.0 : 0.3;
        const double bound = cramer_rao_bound({.signal_events = signal,
                                               .background_events = background,
                                               .centre_bins = centre,
                                               .sigma_bins = 0.04,
                                               .np = np,
                                               .acquisitions = 3333.0,
                                               .kept_events = 2});
        zero_signal.add(bound == kInfinity ? 0.0 : 1.0);
      }
    }
  }
  return {
      zero_background.row("Cramer-Rao bound, no background", "NP 4 to 14; 1e-12 to 1e6 signal events",
                          "closed form sqrt((sigma^2 + 1/12) / events)", 0.008, "(bin / sigma)^4 or 1e-9"),
      zero_signal.row("Cramer-Rao bound, nothing to see",
                      "no signal, or a pulse far outside; 0 to 1e6 background", "infinite", 0.0,
                      "finite bounds")};
}

std::vector<StabilityResult> check_tables() {
  Largest order;
  Largest flat;
  const auto check_order = [&](const std::vector<CalibrationPoint>& points) {
    LookupTable table = LookupTable::fit(points);
    double before = -kInfinity;
    for (double position = -50.0; position <= 1100.0; position += 0.25) {
      const double distance = table.distance(position);
      order.add(std::isfinite(distance) ? std::max(before - distance, 0.0) : kInfinity);
      before = distance;
    }
    return table;
  };
  check_order({{0.0, 5.0}, {500.0, 3.0}, {1000.0, 1.0}});
  check_order({{0.0, 1.0}, {1.0, 1.0 + 1e-15}, {2.0, 1.0}, {1000.0, 1e9}});
  check_order({{10.0, 0.5}, {10.0, 1.5}, {10.0, 2.5}});
  constexpr int kZigzagPoints = 200;
  std::vector<CalibrationPoint> zigzag;
  zigzag.reserve(kZigzagPoints);
  for (int i = 0; i < kZigzagPoints; ++i) {
    zigzag.push_back({5.0 * i, 0.03 * i + (i % 2 == 0 ? 0.2 : -0.2)});
  }
  check_order(zigzag);
  for (const double distance : {1e-9, 1.0, 6.0}) {
    const LookupTable table = check_order({{3.0, distance}, {700.0, distance}, {900.0, distance}});
    for (const double position : {0.0, 500.0, 1022.0}) {
      flat.relative(table.distance(position), Real(distance));
    }
  }
  Largest depth;
  for (int np = 4; np <= 14; ++np) {
    const DepthScale scale(45e-9, np, 2e-9);
    for (const double metres : {1e-6, 0.05, 1.0, 6.4}) {
      depth.add(std::abs(scale.depth(scale.position(metres)) - metres) / metres);
    }
  }
  return {order.row("look-up table: finite and not falling",
                    "falling, flat, zigzag and repeated calibrations", "monotone", 0.0, "m"),
          flat.row("look-up table of a flat calibration", "1e-9, 1 and 6 m", "the distance", 0.0),
          depth.row("position to depth and back", "NP 4 to 14, 1e-6 to 6.4 m", "identity", 2e-10)};
}

StabilityResult check_refusals() {
  Largest accepted;
  const auto refused = [&](const std::function<void()>& action) {
    try {
      action();
      accepted.add(1.0);
    } catch (const InputError& error) {
      accepted.add(std::string(error.what()).empty() ? 1.0 : 0.0);
    }
  };
  for (const double bad : {kNan, kInfinity, -1.0}) {
    const auto with = [&](double SensorModel::*field) {
      refused([&] {
        SensorModel sensor;
        sensor.*field = bad;
        sensor.validate();
      });
    };
    with(&SensorModel::integration_time_s);
    with(&SensorModel::pulse_fwhm_s);
    with(&SensorModel::signal_events_1m);
    with(&SensorModel::background_events_per_klux);
    with(&SensorModel::dark_count_rate_hz);
    with(&SensorModel::dead_time_s);
    refused([&] { PhotonSource(SensorModel(), TargetMap(1, 1, {.depth_m = 1.0}), bad, 1); });
    refused([&] {
      PhotonSource(SensorModel(), TargetMap(1, 1, {.depth_m = 1.0, .reflectivity = bad}), 14.0, 1);
    });
    refused([&] {
      choose_fidelity(PhotonSource(SensorModel(), TargetMap(1, 1, {.depth_m = 1.0}), 14.0, 1),
                      {.tolerance = bad, .use = PhotonUse::kStream, .readouts = {}});
    });
    refused([&] {
      (void)LookupTable::fit(std::vector<CalibrationPoint>{{0.0, 1.0}, {bad == -1.0 ? kNan : bad, 2.0}});
    });
    refused([&] { ErrorStatistics().add(1.0, bad == -1.0 ? kNan : bad); });
  }
  // The mean number of events overflows.
  refused([] { PhotonSource(SensorModel(), TargetMap(1, 1, {.depth_m = 1e-200}), 14.0, 1); });
  SensorModel dead = SensorModel();
  dead.dead_time_s = 1e-9;
  refused([&] { (void)expected_detections(dead, {}); });
  const PhotonSource exact(dead, TargetMap(1, 1, {.depth_m = 1.0}), 14.0, 1);
  refused([&] { FastPhotonSource{exact}; });
  refused([&] { MeanPhotonSource{exact}; });
  return accepted.row("refusals",
                      "NaN, infinite, negative or overflowing inputs; models asked for what they lack",
                      "InputError with a reason", 0.0, "accepted");
}

TEST(Stability, Statistics) { expect_stable(check_statistics()); }

TEST(Stability, Peaks) { expect_stable(check_peaks()); }

TEST(Stability, Distributions) { expect_stable({check_distributions()}); }

TEST(Stability, CramerRaoBounds) { expect_stable(check_bounds()); }

TEST(Stability, LookupTables) { expect_stable(check_tables()); }

TEST(Stability, Refusals) { expect_stable({check_refusals()}); }

TEST(Stability, AnErrorThatIsNoNumberIsNotAccepted) {
  Largest largest;
  largest.add(std::numeric_limits<double>::quiet_NaN());
  largest.add(0.0);
  EXPECT_FALSE(largest.row("", "", "", 1e300).passed());
}

}  // namespace
}  // namespace dtof
