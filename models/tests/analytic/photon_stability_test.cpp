// SPDX-License-Identifier: Apache-2.0
// Photon models: largest errors over the extremes that scenes and sensors can have, against 50-digit
// arithmetic, closed forms or exact integers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "dtof/core/random.hpp"
#include "dtof/photon/arrival_table.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "tests/analytic/stability.hpp"
#include "tests/core/test_seed.hpp"

namespace dtof {
namespace {

struct ExtremePixel {
  SensorModel sensor;
  PixelRates rates;
};

/// NP, pulse widths from a tenth of a bin to the range, pulses at, across and beyond both ends, means from 0
/// to 1e6.
std::vector<ExtremePixel> extreme_pixels() {
  std::vector<ExtremePixel> pixels;
  for (const int np : {4, 10, 14}) {
    const double range = std::ldexp(1.0, np);
    for (const double fwhm : {0.1, 1.0, 45.5, range}) {
      const SensorModel sensor = sensor_of(np, fwhm);
      for (const double centre : {-range, -3.0, 0.0, 0.5, 0.37 * range, range - 0.5, range, 3.0 * range}) {
        for (const double signal : {0.0, 1e-12, 1e-6, 0.3, 480.0, 1e6}) {
          for (const double background : {0.0, 1e-12, 0.15, 2.1, 1e6}) {
            pixels.push_back({sensor, {background, signal, centre}});
          }
        }
      }
    }
  }
  return pixels;
}

Real exact_mean(const ExtremePixel& pixel, const Real& begin, const Real& end) {
  const Real range = Real(std::ldexp(1.0, pixel.sensor.np));
  const Real sigma = Real(pulse_sigma_s(pixel.sensor.pulse_fwhm_s) / pixel.sensor.time_resolution_s());
  const Real centre(pixel.rates.centre_bins);
  return Real(pixel.rates.background) * (end - begin) / range +
         Real(pixel.rates.signal) * exact_normal_share((begin - centre) / sigma, (end - centre) / sigma);
}

/// C(t) in doubles.
double mean_before(const ExtremePixel& pixel, double time) {
  const double sigma = pulse_sigma_s(pixel.sensor.pulse_fwhm_s) / pixel.sensor.time_resolution_s();
  const auto below = [&](double t) {
    return 0.5 * std::erfc(-(t - pixel.rates.centre_bins) / sigma / std::numbers::sqrt2);
  };
  return pixel.rates.background * std::ldexp(time, -pixel.sensor.np) +
         pixel.rates.signal * (below(time) - below(0.0));
}

std::string extremes_text() {
  return "NP 4, 10, 14; FWHM 0.1 bin to the range; pulse inside, at, across and beyond both ends; 0 to 1e6 "
         "events";
}

StabilityResult check_survival() {
  Largest largest;
  for (int exponent = -12; exponent <= 6; ++exponent) {
    for (const double factor : {1.0, 2.3, 7.7}) {
      const double mean = factor * std::pow(10.0, exponent);
      Real kept = 0;
      for (int k = 1; k <= 4; ++k) {
        const Real probability = exact_at_least(k, Real(mean));
        largest.relative(at_least(k, mean), probability);
        kept += probability;
        largest.relative(kept_events(mean, k), kept);
      }
    }
  }
  return largest.row("P(N >= k), E[min(N, SLOTS)]", "mean 1e-12 to 7.7e6, k and SLOTS 1 to 4", "50 digits",
                     1e-13);
}

std::vector<StabilityResult> check_expected_detections() {
  Largest totals;
  Largest bins;
  Largest tables;
  Largest round_trip;
  for (const ExtremePixel& pixel : extreme_pixels()) {
    const auto slots = expected_slot_detections(pixel.sensor, pixel.rates);
    const double range = std::ldexp(1.0, pixel.sensor.np);
    const Real events = exact_mean(pixel, Real(0), Real(range));
    for (std::size_t k = 0; k < slots.size(); ++k) {
      const Real total = exact_at_least(static_cast<int>(k) + 1, events);
      const double sum = std::accumulate(slots[k].begin(), slots[k].end(), 0.0);
      // Below the smallest double a total is 0.
      totals.add(sum, total, total > 1e-290 ? total : Real(1e-290));
      const std::size_t code = std::min<std::size_t>(slots[k].size() * 37 / 100, slots[k].size() - 1);
      const Real before = exact_mean(pixel, Real(0), Real(code));
      const Real after = exact_mean(pixel, Real(0), Real(code + 1));
      const Real bin =
          exact_at_least(static_cast<int>(k) + 1, after) - exact_at_least(static_cast<int>(k) + 1, before);
      bins.add(slots[k][code], bin, total > 1e-290 ? total : Real(1e-290));
    }
    ArrivalTable table(pixel.sensor);
    table.build(pixel.rates);
    const Real scale = events > 1e-290 ? events : Real(1e-290);
    tables.add(table.total(), events, scale + Real(pixel.rates.signal));
    double before = 0.0;
    for (int i = 0; table.total() > 0.0 && i <= 64; ++i) {
      const double point = table.total() * std::min(i / 64.0, 1.0 - 1e-15);
      const double time = table.inverse(point);
      const bool inside = time >= before && time < range;  // false for a NaN
      round_trip.add(inside ? std::abs(mean_before(pixel, time) - point) /
                                  (pixel.rates.background + pixel.rates.signal)
                            : kInfinity);
      before = time;
    }
  }
  return {totals.row("expected detections, a slot's total", extremes_text(), "50 digits", 1e-11),
          bins.row("expected detections of one bin / slot's total", extremes_text(), "50 digits", 1e-13),
          tables.row("table of C(t), total / events", extremes_text(), "50 digits", 5e-12),
          round_trip.row("table of C(t), inverse: in order, inside, C(inverse(x)) = x", extremes_text(),
                         "closed form", 2e-4, "share of the events")};
}

/// Detections of a column of equal pixels against their expected number, in standard deviations; and order,
/// range and slots of every stream.
void add_source(const StreamSource& source, const SensorModel& sensor, double mean, double variance,
                Largest& deviation, Largest& violations) {
  double count = 0.0;
  for (int column = 0; column < source.columns(); ++column) {
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      const auto detections = stream.row(row);
      double wrong = 0.0;
      for (std::size_t i = 0; i < detections.size(); ++i) {
        const auto slots = static_cast<std::size_t>(sensor.slots);
        const bool ordered =
            i == 0 || std::pair(detections[i - 1].acquisition, detections[i - 1].timestamp) <=
                          std::pair(detections[i].acquisition, detections[i].timestamp);
        const bool full = i >= slots && detections[i - slots].acquisition == detections[i].acquisition;
        const bool outside = detections[i].acquisition >= sensor.acquisitions ||
                             detections[i].timestamp >> static_cast<unsigned>(sensor.np) != 0;
        wrong += !ordered || full || outside ? 1.0 : 0.0;
      }
      violations.add(wrong);
      count += static_cast<double>(detections.size());
    }
  }
  const double pixels = source.columns() * source.rows();
  // Half a detection is the resolution of a count.
  const double spread = std::sqrt(std::max(pixels * variance, 0.0));
  deviation.add(std::max(std::abs(count - pixels * mean) - 0.5, 0.0) / std::max(spread, 0.5));
}

std::vector<StabilityResult> check_sources(std::uint64_t seed) {
  Largest exact_deviation;
  Largest fast_deviation;
  Largest sampler_deviation;
  Largest mean_deviation;
  Largest violations;
  struct Target {
    double depth_m;
    double reflectivity;
  };
  constexpr std::array<Target, 10> kTargets = {{{0.05, 4.0},
                                                {0.05, 1.0},
                                                {1.0, 0.0},
                                                {1.0, 1e-6},
                                                {1.0, 1.0},
                                                {6.4, 1.0},
                                                {6.75, 1.0},
                                                {9.0, 1.0},
                                                {0.0, 1.0},
                                                {kInfinity, 0.5}}};
  for (const int np : {4, 10, 14}) {
    for (const double fwhm_s : {4.4e-12, 2e-9, 45e-9}) {
      for (const double klux : {0.0, 14.0, 200.0}) {
        for (const Target& target : kTargets) {
          SensorModel sensor;
          sensor.np = np;
          sensor.pulse_fwhm_s = fwhm_s;
          sensor.acquisitions = 1000;
          const PhotonSource exact(
              sensor, TargetMap(1, 4, {.depth_m = target.depth_m, .reflectivity = target.reflectivity}), klux,
              seed);
          const auto slots = expected_slot_detections(sensor, exact.rates(0, 0));
          // Kept detections of an acquisition: N_1 + N_2 with N_2 <= N_1, both 0 or 1.
          const double first = std::accumulate(slots[0].begin(), slots[0].end(), 0.0);
          const double second = std::accumulate(slots[1].begin(), slots[1].end(), 0.0);
          const double mean = first + second;
          const double variance = std::max(first + 3.0 * second - mean * mean, 0.0);
          const double frame = sensor.acquisitions;
          const FastPhotonSource fast(exact);
          add_source(exact, sensor, frame * mean, frame * variance, exact_deviation, violations);
          add_source(fast, sensor, frame * mean, frame * variance, fast_deviation, violations);
          const auto sampler = fast.pixel_sampler();
          double count = 0.0;
          for (int row = 0; row < 4; ++row) {
            sampler->start_pixel(0, row);
            const auto codes = sampler->draw(sensor.acquisitions, 0, 1 << np);
            count += static_cast<double>(codes.size());
            violations.add(static_cast<double>(std::ranges::count_if(
                codes, [&](Timestamp code) { return code >> static_cast<unsigned>(np) != 0; })));
          }
          sampler_deviation.add(std::max(std::abs(count - 4.0 * frame * mean) - 0.5, 0.0) /
                                std::max(std::sqrt(4.0 * frame * variance), 0.5));
          add_source(MeanPhotonSource(exact), sensor, frame * mean, 0.0, mean_deviation, violations);
        }
      }
    }
  }
  const std::string inputs =
      "0.05 m with rho 4 (480 events per pulse) to 9 m and no target; rho 0, 1e-6; 0, 14, 200 klux; NP 4, "
      "10, "
      "14; "
      "FWHM 4.4 ps to 45 ns";
  const std::string number = "number of detections: closed form";
  return {
      exact_deviation.row("exact photon source", inputs, number, kSixSigma, "standard deviations"),
      fast_deviation.row("fast photon source, streams", inputs, number, kSixSigma, "standard deviations"),
      sampler_deviation.row("fast photon source, sampler", inputs, number, kSixSigma, "standard deviations"),
      mean_deviation.row("analytic photon source, 4 pixels", inputs, number, 8.0, "half detections"),
      violations.row("all photon sources", inputs, "time order, range, at most SLOTS: exact", 0.0,
                     "violations")};
}

std::vector<StabilityResult> check_dense_pulses(std::uint64_t seed) {
  // First event of a dense pulse: P(T > t) = exp(-C(t)); mean and variance by summation in long double.
  Largest deviation;
  Largest dead;
  for (const double signal : {30.0, 480.0, 1e4, 1e6}) {
    SensorModel sensor;
    sensor.acquisitions = 20000;
    const ExtremePixel pixel{sensor, {0.15, signal, 300.0}};
    long double mean = 0.0L;
    long double square = 0.0L;
    constexpr double kStep = 0.01;
    for (double time = 0.0; time < 1024.0; time += kStep) {
      const long double alive = std::exp(-static_cast<long double>(mean_before(pixel, time + kStep / 2)));
      mean += alive * kStep;
      square += 2.0L * (time + kStep / 2) * alive * kStep;
    }
    EventSampler sampler(sensor, 1);
    double sum = 0.0;
    double count = 0.0;
    for (const double position :
         sampler.sample(pixel.rates, {seed, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 1})) {
      sum += std::fmod(position, 1024.0);
      count += 1.0;
    }
    const auto spread = static_cast<double>(std::sqrt(square - mean * mean));
    deviation.add(std::abs(sum / count - static_cast<double>(mean)) / spread * std::sqrt(count));

    sensor.dead_time_s = 1.0;
    EventSampler single(sensor, EventSampler::kAll);
    if (signal < 1e4) {
      const auto events =
          single.sample(pixel.rates, {seed, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 2});
      dead.add(std::abs(static_cast<double>(events.size()) - sensor.acquisitions));
    }
  }
  return {
      deviation.row("first event of a dense pulse, mean time", "30 to 1e6 events per pulse, 20,000 pulses",
                    "quadrature of exp(-C(t)), long double", kSixSigma, "standard deviations"),
      dead.row("dead time of 1 s (range 45 ns)", "30 and 480 events per pulse",
               "one detection per acquisition", 0.0, "detections")};
}

TEST(PhotonStability, SurvivalOfFewAndManyEvents) { expect_stable({check_survival()}); }

TEST(PhotonStability, ExpectedDetections) { expect_stable(check_expected_detections()); }

TEST(PhotonStability, PhotonSources) {
  SCOPED_TRACE(test_seed_message());
  expect_stable(check_sources(test_seed()));
}

TEST(PhotonStability, DensePulses) {
  SCOPED_TRACE(test_seed_message());
  expect_stable(check_dense_pulses(test_seed()));
}

}  // namespace
}  // namespace dtof
