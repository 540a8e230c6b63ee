// SPDX-License-Identifier: Apache-2.0
#include "rivals/paper_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "dtof/core/error.hpp"
#include "dtof/rival/coarse_histogram.hpp"
#include "dtof/rival/equi_depth.hpp"
#include "dtof/rival/guided_window.hpp"
#include "dtof/rival/legendre_memory.hpp"
#include "dtof/rival/linear_code.hpp"
#include "dtof/rival/online_em.hpp"
#include "rivals/recent_claims.hpp"
#include "rivals/scene_claims.hpp"

namespace dtof {
namespace {

constexpr double kThesisPulse = 0.0189;  // sigma of 2 ns FWHM in 45 ns
constexpr int kCountBits = 16;           // no counter is ever full: the papers' are not
constexpr std::size_t kGuidedFrames = 3;

/// Codes to try on one kind of photons.
class Bench {
 public:
  explicit Bench(const IndependentPhotons& photons) : photons_(photons), sensor_(photons.sensor()) {}

  [[nodiscard]] const SensorModel& sensor() const { return sensor_; }
  void add(std::string family, std::string code, int values, std::unique_ptr<Rival> rival) {
    codes_.push_back({std::move(code), std::move(family), values, rival->bits_per_pixel(), {}, 0.0});
    estimators_.push_back(estimator_of(std::move(rival)));
  }
  void add(std::string family, std::string code, int values, int bits, PlaceEstimator estimator) {
    codes_.push_back({std::move(code), std::move(family), values, bits, {}, 0.0});
    estimators_.push_back(std::move(estimator));
  }

  [[nodiscard]] PlaceErrors errors(std::size_t pixels, const PaperClaimSettings& settings) const {
    return place_errors(photons_, estimators_, pixels, settings.seed, settings.threads, kGuidedFrames);
  }

  [[nodiscard]] PaperScene scene(std::string name, std::string description, const PlaceErrors& found) const {
    PaperScene scene{std::move(name), std::move(description), photons_, photons_.cramer_rao_bound(), codes_};
    const double far = 3.0 * photons_.pulse_sigma * std::ldexp(1.0, photons_.np);
    for (std::size_t i = 0; i < scene.codes.size(); ++i) {
      const std::vector<double>& errors = found.errors[i];
      scene.codes[i].rmse = estimate_root_mean_square(errors);
      scene.codes[i].lost =
          static_cast<double>(std::ranges::count_if(errors, [&](double e) { return std::abs(e) > far; })) /
          static_cast<double>(errors.size());
    }
    return scene;
  }

 private:
  IndependentPhotons photons_;
  SensorModel sensor_;
  std::vector<CodePrecision> codes_;
  std::vector<PlaceEstimator> estimators_;
};

/// The middle of the highest bin, as histograms are read without knowledge of the pulse.
PlaceEstimator highest_bin(int bin_bits, int np) {
  return [=](PixelFrames frames) {
    std::vector<int> counts(std::size_t{1} << static_cast<unsigned>(bin_bits), 0);
    const auto shift = static_cast<unsigned>(np - bin_bits);
    for (const Detection& detection : frames.back()) {
      ++counts[static_cast<std::size_t>(detection.timestamp) >> shift];
    }
    const auto best = std::ranges::max_element(counts) - counts.begin();
    return (static_cast<double>(best) + 0.5) * std::ldexp(1.0, np - bin_bits) - 0.5;
  };
}

/// Equi-depth boundaries as exact as all timestamps tell them.
PlaceEstimator exact_equi_depth(int parts, int np) {
  return [=](PixelFrames frames) {
    std::vector<double> times;
    for (const Detection& detection : frames.back()) {
      times.push_back(detection.timestamp + 0.5);
    }
    std::ranges::sort(times);
    std::vector<double> boundaries;
    for (int i = 1; i < parts; ++i) {
      boundaries.push_back(
          times[times.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(parts)]);
    }
    return densest_place(std::move(boundaries), 1 << np).position;
  };
}

void add_full(Bench& bench) {
  const int np = bench.sensor().np;
  bench.add("full histogram", std::string(kFull), 1 << np,
            make_coarse_histogram(bench.sensor(), {.bin_bits = np, .count_bits = 10}));
}

void add_sketch(Bench& bench, int size) {
  bench.add("sketch", fmt::format("sketch M = {}", size), 2 * size, make_sketch(bench.sensor(), size));
}

/// Every code, for photons of 1024 codes.
Bench all_codes(const IndependentPhotons& photons) {
  Bench bench(photons);
  const SensorModel& sensor = bench.sensor();
  add_full(bench);
  for (const int bits : {3, 4, 5, 10}) {
    bench.add("equi-width, highest bin", fmt::format("{} bins, highest", 1 << bits), 1 << bits,
              10 * (1 << bits), highest_bin(bits, sensor.np));
  }
  for (const int bits : {4, 5}) {
    bench.add("equi-width, matched", fmt::format("{} bins, matched", 1 << bits), 1 << bits,
              make_coarse_histogram(sensor, {.bin_bits = bits, .count_bits = kCountBits}));
  }
  for (const int size : {1, 2, 4, 6, 8, 10, 13, 16, 32}) {
    add_sketch(bench, size);
  }
  for (const int knots : {8, 16, 32, 51}) {
    bench.add("spline sketch", fmt::format("spline sketch m = {}", knots), knots,
              make_spline_sketch(sensor, knots, kCountBits));
  }
  for (const int order : {8, 12, 16, 32}) {
    bench.add("Legendre memory", fmt::format("Legendre memory d = {}", order), order,
              make_legendre_memory(sensor, order));
  }
  const auto add_code = [&](const char* title, const std::vector<CodeWave>& waves) {
    constexpr int kWeightBits = 4;
    bench.add(title, fmt::format("{} K = {}", title, waves.size()), static_cast<int>(waves.size()),
              make_linear_code(sensor, {.counters = waves.size(),
                                        .weights = wave_weights(sensor.np, waves, kWeightBits),
                                        .count_bits = kCountBits + kWeightBits,
                                        .is_signed = true}));
  };
  for (const int counters : {8, 10, 16, 32, 64, 100}) {
    add_code("truncated Fourier", truncated_fourier(counters));
  }
  for (const int counters : {8, 10, 16}) {
    add_code("Gray-Fourier", gray_fourier(counters, largest_harmonic(sensor)));
  }
  for (const int parts : {2, 4, 8, 16, 32, 64}) {
    bench.add("HEDH", fmt::format("HEDH-{}", parts), parts - 1,
              make_hierarchical_equi_depth(sensor, {.parts = parts}));
  }
  for (const int parts : {8, 16, 32}) {
    bench.add("PEDH optimised", fmt::format("PEDH-{} optimised", parts), parts - 1,
              make_proportional_equi_depth(sensor, {.parts = parts, .optimised = true}));
  }
  for (const int parts : {2, 8, 16, 32}) {
    bench.add("exact equi-depth", fmt::format("exact equi-depth, {} bins", parts), parts - 1, 0,
              exact_equi_depth(parts, sensor.np));
  }
  bench.add("online EM", "online EM", 2, make_online_em(sensor));
  bench.add("guided window", "guided window", 9, make_guided_window(sensor, {.count_bits = kCountBits}));
  return bench;
}

/// Standard deviation of two correlations' place, as a share of the range.
Estimate precision_of_correlations(const IndependentPhotons& photons, int shift, std::size_t pixels,
                                   const PaperClaimSettings& settings) {
  const PlaceErrors found =
      place_errors(photons, {estimator_of(make_two_correlations(photons.sensor(), shift))}, pixels,
                   settings.seed, settings.threads);
  std::vector<double> shares = found.errors.front();
  for (double& share : shares) {
    share = std::ldexp(share, -photons.np);
  }
  return estimate_standard_deviation(shares);
}

PaperClaim correlations_in_ambient_light(const PaperClaimSettings& settings) {
  constexpr int kShift = 21;
  constexpr double kAmbientToSignal = 120.0;
  constexpr std::size_t kFewer = 10;  // each pixel has eight million detections
  const IndependentPhotons photons{.np = 10,
                                   .pulse_sigma = kThesisPulse,
                                   .detections = std::uint32_t{4} << kShift,
                                   .signal_share = 1.0 / (1.0 + kAmbientToSignal)};
  const Estimate precision = precision_of_correlations(photons, kShift, settings.pixels / kFewer, settings);
  return {
      "Morsy and Kuijk, Sensors 2024, 24(16) 5380 (the correlating pixel of Kuijk, Sensors 2025)",
      "Precision below 1 % of the range at 120 times as much ambient light as signal",
      fmt::format("two triangular waves, mean of 2^{} detections; standard deviation of the place", kShift),
      fmt::format("{:.2f} % of the range ({:.2f} to {:.2f})", 100.0 * precision.value,
                  100.0 * precision.interval.low, 100.0 * precision.interval.high),
      claim_verdict({precision.value < 0.01})};
}

PaperClaim correlations_in_the_dark(const PaperClaimSettings& settings) {
  constexpr int kShift = 12;
  constexpr double kRangeM = 6.0;
  const IndependentPhotons photons{
      .np = 10, .pulse_sigma = kThesisPulse, .detections = std::uint32_t{4} << kShift, .signal_share = 0.9};
  const Estimate precision = precision_of_correlations(photons, kShift, settings.pixels, settings);
  return {
      "Kuijk et al., Sensors 2025, 25(21) 6772", "Precision below one centimetre over 6 m",
      fmt::format("nine of ten detections are signal, mean of 2^{} detections; standard deviation over 6 m",
                  kShift),
      fmt::format("{:.2f} cm ({:.2f} to {:.2f})", 100.0 * kRangeM * precision.value,
                  100.0 * kRangeM * precision.interval.low, 100.0 * kRangeM * precision.interval.high),
      claim_verdict({kRangeM * precision.value < 0.01})};
}

PaperClaim windows_save_memory(const PaperClaimSettings& settings) {
  constexpr int kNp = 14;
  constexpr double kClaimed = 1548.0;
  const IndependentPhotons photons{
      .np = kNp, .pulse_sigma = kThesisPulse, .detections = 1000, .signal_share = 0.5};
  Bench bench(photons);
  constexpr int kWindowCountBits = 10;
  bench.add("guided window", "guided window", 9,
            make_guided_window(bench.sensor(), {.count_bits = kWindowCountBits}));
  const PaperScene scene = bench.scene("foveated", "", bench.errors(settings.pixels, settings));
  const CodePrecision& window = scene.codes.front();
  const double reduction = std::ldexp(kWindowCountBits, kNp) / window.bits;
  return {
      "Folden, Ingle and Koppal, FoveaSPAD (arXiv 2412.02052)",
      "A window around what is known of the depth takes up to 1548 times less memory",
      "guided window of eight bins beside a histogram of 2^14 bins: memory, and the error in its third frame "
      "beside the Cramer-Rao bound",
      fmt::format("{:.0f} times less, {:.2f} times the bound, {:.1f} % of the pixels lost", reduction,
                  window.rmse.value / scene.bound, 100.0 * window.lost),
      claim_verdict({reduction >= kClaimed && window.rmse.value <= kNegligibleLoss * scene.bound})};
}

}  // namespace

std::string_view claim_verdict_word(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::kHolds:
      return "holds";
    case ClaimVerdict::kInPart:
      return "in part";
    case ClaimVerdict::kFails:
      break;
  }
  return "fails";
}

ClaimVerdict claim_verdict(const std::vector<bool>& conditions) {
  const auto held = std::ranges::count(conditions, true);
  return held == std::ssize(conditions) ? ClaimVerdict::kHolds
         : held > 0                     ? ClaimVerdict::kInPart
                                        : ClaimVerdict::kFails;
}

PaperClaims judge_paper_claims(const PaperClaimSettings& settings) {
  constexpr std::size_t kFewestPixels = 100;
  if (settings.pixels < kFewestPixels) {
    throw InputError(
        fmt::format("paper claims: {} pixels, but it must be at least {}", settings.pixels, kFewestPixels));
  }
  const Bench even_bench = all_codes({10, kThesisPulse, 1000, 0.5});
  const Bench sunlit_bench = all_codes({10, kThesisPulse, 10'000, 1.0 / 11.0});
  const Bench narrow_bench = all_codes({10, 4.0 / 1024.0, 1000, 0.5});
  const PlaceErrors even = even_bench.errors(settings.pixels, settings);
  const PlaceErrors narrow = narrow_bench.errors(settings.pixels, settings);
  PaperClaims result;
  result.scenes = {
      even_bench.scene("even", "1000 detections, half of them signal; the thesis's pulse", even),
      sunlit_bench.scene("sunlit",
                         "10,000 detections, ten of the background for each of the signal; the same pulse",
                         sunlit_bench.errors(settings.pixels, settings)),
      narrow_bench.scene("narrow", "1000 detections, half of them signal; a pulse of a fifth of that width",
                         narrow)};
  Bench fine_bench({12, kThesisPulse, 1000, 0.5});
  add_full(fine_bench);
  add_sketch(fine_bench, 13);
  constexpr std::size_t kLessPixels = 4;  // a place among 4096 costs sixteen times as much
  result.scenes.push_back(
      fine_bench.scene("fine", "the even photons in 4096 codes",
                       fine_bench.errors(std::max(kFewestPixels, settings.pixels / kLessPixels), settings)));

  result.claims = claims_of_scenes(result.scenes, even, narrow);
  for (const auto& judge : {correlations_in_ambient_light, correlations_in_the_dark, windows_save_memory}) {
    result.claims.push_back(judge(settings));
  }
  std::ranges::move(judge_recent_claims(settings), std::back_inserter(result.claims));
  return result;
}

}  // namespace dtof
