// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "dtof/analytic/code_distribution.hpp"
#include "dtof/analytic/fidelity.hpp"
#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "dtof/metrics/cramer_rao.hpp"
#include "dtof/metrics/depth.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/metrics/lookup_table.hpp"
#include "dtof/photon/arrival_table.hpp"
#include "dtof/photon/expected_detections.hpp"
#include "dtof/photon/fast_photon_source.hpp"
#include "dtof/photon/mean_photon_source.hpp"
#include "dtof/photon/physics.hpp"
#include "dtof/readout/histogram.hpp"
#include "tests/core/test_seed.hpp"

// Largest errors over the extremes that scenes, sensors and calibrations can have, against 50-digit
// arithmetic, closed forms or exact integers.
namespace dtof {
namespace {

/// What one check found over its grid of inputs.
struct StabilityResult {
  std::string what;       ///< function or model
  std::string inputs;     ///< what was swept
  std::string reference;  ///< what it was compared with
  std::uint64_t cases;    ///< values compared
  double error;           ///< largest; NaN in a result counts as infinite
  double limit;           ///< accepted
  std::string unit;       ///< of error and limit

  [[nodiscard]] bool passed() const { return error <= limit; }
};

using Real = boost::multiprecision::cpp_bin_float_50;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSixSigma = 6.0;

/// Collects the largest error of a row.
class Largest {
 public:
  void add(double error) {
    ++cases_;
    // Written so that a NaN is the worst.
    error_ = error <= error_ ? error_ : (std::isnan(error) ? kInfinity : error);
  }
  /// |value - reference| / scale, in units of the last place of a double where scale is the reference.
  void add(double value, const Real& reference, const Real& scale) {
    if (!std::isfinite(value)) {
      add(kInfinity);
      return;
    }
    const Real difference = abs(Real(value) - reference);
    add(difference == 0 ? 0.0 : static_cast<double>(difference / scale));
  }
  void relative(double value, const Real& reference) { add(value, reference, abs(reference)); }

  [[nodiscard]] StabilityResult row(std::string what, std::string inputs, std::string reference, double limit,
                                    std::string unit = "relative") const {
    return {std::move(what), std::move(inputs), std::move(reference), cases_, error_, limit, std::move(unit)};
  }

 private:
  std::uint64_t cases_ = 0;
  double error_ = 0.0;
};

/// P(N >= k), N Poisson.
Real exact_at_least(int k, const Real& mean) {
  return mean == 0 ? Real(k == 0 ? 1 : 0) : (k == 0 ? Real(1) : boost::math::gamma_p(Real(k), mean));
}

Real exact_normal_share(const Real& from, const Real& to) {
  const Real root = sqrt(Real(2));
  // Both tails on the side where they are small.
  return from > 0 ? (boost::math::erfc(from / root) - boost::math::erfc(to / root)) / 2
                  : (boost::math::erfc(-to / root) - boost::math::erfc(-from / root)) / 2;
}

struct ExtremePixel {
  SensorModel sensor;
  PixelRates rates;
};

SensorModel sensor_of(int np, double fwhm_bins) {
  SensorModel sensor;
  sensor.np = np;
  sensor.pulse_fwhm_s = fwhm_bins * sensor.time_resolution_s();
  return sensor;
}

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

/// A limit is at most ten times what is observed, so that a loss of accuracy is noticed; random draws have
/// limits of six standard deviations (a right model exceeds them twice in 1e9 cases), whatever was drawn.
void expect_stable(const std::vector<StabilityResult>& results) {
  for (const StabilityResult& result : results) {
    SCOPED_TRACE(result.what + " over " + result.inputs + ", against " + result.reference + ", in " +
                 result.unit);
    EXPECT_GT(result.cases, 0U);
    EXPECT_LE(result.error, result.limit);
    if (result.unit != "standard deviations") {
      EXPECT_LE(result.limit, 10.0 * result.error);
    }
  }
}

TEST(Stability, SurvivalOfFewAndManyEvents) { expect_stable({check_survival()}); }

TEST(Stability, ExpectedDetections) { expect_stable(check_expected_detections()); }

TEST(Stability, PhotonSources) {
  SCOPED_TRACE(test_seed_message());
  expect_stable(check_sources(test_seed()));
}

TEST(Stability, DensePulses) {
  SCOPED_TRACE(test_seed_message());
  expect_stable(check_dense_pulses(test_seed()));
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
