// SPDX-License-Identifier: Apache-2.0
#include "rivals/recent_claims.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include "dtof/metrics/error_estimates.hpp"
#include "dtof/metrics/error_statistics.hpp"
#include "dtof/rival/bin_matcher.hpp"
#include "dtof/rival/cfar_detector.hpp"
#include "dtof/rival/equi_depth.hpp"
#include "dtof/rival/equi_depth_fit.hpp"
#include "dtof/rival/legendre_memory.hpp"
#include "dtof/rival/linear_code.hpp"
#include "dtof/rival/linearised_average.hpp"
#include "dtof/rival/optimised_code.hpp"
#include "dtof/rival/pulse_shape.hpp"
#include "rivals/flux_photons.hpp"
#include "rivals/joint_claim.hpp"

namespace dtof {
namespace {

constexpr double kPulseShare = 0.0189;  // the thesis's pulse: sigma of 2 ns FWHM in 45 ns

/// Two of the photons of paper_claims.cpp.
struct NamedLight {
  std::string_view name;
  IndependentPhotons photons;
};
constexpr std::array kTwoLights = {
    NamedLight{"even", {.np = 10, .pulse_sigma = kPulseShare, .detections = 1000, .signal_share = 0.5}},
    NamedLight{"sunlit",
               {.np = 10, .pulse_sigma = kPulseShare, .detections = 10'000, .signal_share = 1.0 / 11.0}}};

double share_of(const std::vector<double>& errors, double limit) {
  const auto within = std::ranges::count_if(errors, [=](double error) { return std::abs(error) <= limit; });
  return static_cast<double>(within) / static_cast<double>(errors.size());
}

/// Sum and number of the codes that a SPAD's first photon in each acquisition has.
std::pair<double, double> first_photons(std::span<const Detection> frame) {
  double sum = 0.0;
  double number = 0.0;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    if (i == 0 || frame[i].acquisition != frame[i - 1].acquisition) {
      sum += frame[i].timestamp;
      number += 1.0;
    }
  }
  return {sum, number};
}

/// The average of first photons less that of a frame without laser light.
double average_of_first_photons(PixelFrames frames) {
  const auto [dark_sum, dark_number] = first_photons(frames[0]);
  const auto [sum, number] = first_photons(frames[1]);
  return number > dark_number ? (sum - dark_sum) / (number - dark_number) : 0.0;
}

/// Mean error in the near, middle and far third of the range.
std::array<double, 3> mean_errors_by_third(const PlaceErrors& found, std::size_t estimator, double codes) {
  std::array<double, 3> sums{};
  std::array<double, 3> numbers{};
  for (std::size_t pixel = 0; pixel < found.places.size(); ++pixel) {
    const auto third = std::min<std::size_t>(2, static_cast<std::size_t>(3.0 * found.places[pixel] / codes));
    sums[third] += found.errors[estimator][pixel];
    numbers[third] += 1.0;
  }
  for (std::size_t third = 0; third < sums.size(); ++third) {
    sums[third] /= std::max(1.0, numbers[third]);
  }
  return sums;
}

PaperClaim average_without_pile_up(const PaperClaimSettings& settings) {
  const FluxPhotons photons{
      .pulse_sigma = kPulseShare, .signal_events = 0.5, .background_events = 1.0, .acquisitions = 4000};
  const PlaceErrors found = flux_errors(
      photons, {estimator_of(make_linearised_average(photons.sensor())), average_of_first_photons},
      settings.pixels, settings.seed, settings.threads, 2, 1);
  const double codes = std::ldexp(1.0, photons.np);
  const double limit = 0.5 * photons.pulse_sigma * codes;
  const std::array<double, 3> linearised = mean_errors_by_third(found, 0, codes);
  const std::array<double, 3> first = mean_errors_by_third(found, 1, codes);
  std::vector<bool> held;
  for (const double error : linearised) {
    held.push_back(std::abs(error) <= limit);
  }
  return {
      "Tontini et al. (FBK), IEEE Sensors Journal 24(4), 2024 (arXiv 2310.09176)",
      "An average of timestamps tells the distance, far beyond the usual pile-up limit of 5 % detections "
      "a pulse",
      fmt::format("1 background and 0.5 signal photons a pulse: a SPAD would fire at {:.0f} % of the pulses; "
                  "mean error in the near, middle and far third of the range, at most half a standard "
                  "deviation of the pulse ({:.1f} codes)",
                  100.0 * -std::expm1(-photons.background_events - photons.signal_events), limit),
      fmt::format(
          "{:.1f}, {:.1f} and {:.1f} codes (average of first photons: {:.0f}, {:.0f} and {:.0f}); one "
          "pixel's root mean square error is {:.0f} codes",
          linearised[0], linearised[1], linearised[2], first[0], first[1], first[2],
          estimate_root_mean_square(found.errors[0]).value),
      claim_verdict(held)};
}

PaperClaim early_reports(const PaperClaimSettings& settings) {
  constexpr double kHalf = 0.5;
  constexpr double kMostWrong = 0.01;
  constexpr std::size_t kTimeWord = 6;
  std::vector<std::string> texts;
  std::vector<bool> held;
  for (const auto& [name, photons] : kTwoLights) {
    const std::shared_ptr<const Rival> cfar = make_cfar_detector(photons.sensor(), {.count_bits = 16});
    const PlaceEstimator time = [cfar](PixelFrames frames) {
      return static_cast<double>(cfar->read_pixel(frames)[kTimeWord]);
    };
    const PlaceEstimator position = [cfar](PixelFrames frames) {
      return cfar->decode(cfar->read_pixel(frames)).position;
    };
    const std::unique_ptr<Rival> whole =
        make_cfar_detector(photons.sensor(), {.count_bits = 16, .early = false});
    const PlaceEstimator at_the_end = [&whole](PixelFrames frames) {
      return whole->decode(whole->read_pixel(frames)).position;
    };
    const PlaceErrors found =
        place_errors(photons, {time, position, at_the_end}, settings.pixels, settings.seed, settings.threads);
    std::vector<double> times;
    std::size_t wrong = 0;
    const double far = 3.0 * photons.pulse_sigma * std::ldexp(1.0, photons.np);
    for (std::size_t pixel = 0; pixel < settings.pixels; ++pixel) {
      times.push_back((found.errors[0][pixel] + found.places[pixel]) / photons.detections);
      wrong += std::abs(found.errors[1][pixel]) > far ? 1U : 0U;
    }
    const double wrong_share = static_cast<double>(wrong) / static_cast<double>(settings.pixels);
    const double middle = median(times);
    held.push_back(middle <= kHalf && wrong_share <= kMostWrong);
    texts.push_back(fmt::format(
        "{}: {:.1f} % of the frame, {:.2f} % wrong, root mean square error {:.1f} codes (whole frame: "
        "{:.1f})",
        name, 100.0 * middle, 100.0 * wrong_share, estimate_root_mean_square(found.errors[1]).value,
        estimate_root_mean_square(found.errors[2]).value));
  }
  return {"Liu et al., arXiv 2509.19192",
          "A pixel that reports as soon as its peak is significant has a lower latency than a frame",
          "32 bins, even and sunlit photons: half of the pixels report within half of the frame, and at most "
          "1 % are wrong by more than three standard deviations of the pulse (the paper's 2.4 us belong to "
          "its FPGA's circuit, which is not modelled)",
          fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

/// Mean counts of 32 bins.
std::vector<double> bin_means(const FluxPhotons& photons, double place) {
  constexpr std::size_t kBinsOfTheRange = 32;
  const double codes = std::ldexp(1.0, photons.np);
  const double sigma = photons.pulse_sigma * codes;
  const double width = codes / static_cast<double>(kBinsOfTheRange);
  std::vector<double> means;
  for (std::size_t bin = 0; bin < kBinsOfTheRange; ++bin) {
    const auto before = [&](double code) {
      return 0.5 * std::erfc((place + 0.5 - code) / sigma / std::sqrt(2.0));
    };
    const double begin = width * static_cast<double>(bin);
    means.push_back(photons.acquisitions * (photons.background_events / static_cast<double>(kBinsOfTheRange) +
                                            photons.signal_events * (before(begin + width) - before(begin))));
  }
  return means;
}

PaperClaim probability_of_a_raw_peak(const PaperClaimSettings& settings) {
  std::vector<std::string> texts;
  std::vector<bool> held;
  for (const double signal : {0.05, 0.1, 0.2}) {
    const FluxPhotons photons{
        .pulse_sigma = kPulseShare, .signal_events = signal, .background_events = 2.0, .acquisitions = 100};
    const PlaceEstimator highest = [](PixelFrames frames) {
      std::array<int, 32> counts{};
      for (const Detection& detection : frames.back()) {
        ++counts.at(detection.timestamp / 32U);
      }
      return static_cast<double>(std::ranges::max_element(counts) - counts.begin());
    };
    const PlaceErrors found =
        flux_errors(photons, {highest}, settings.pixels, settings.seed, settings.threads);
    double predicted = 0.0;
    std::uint64_t seen = 0;
    for (std::size_t pixel = 0; pixel < settings.pixels; ++pixel) {
      const std::vector<double> means = bin_means(photons, found.places[pixel]);
      const auto bin = static_cast<std::size_t>(std::ranges::max_element(means) - means.begin());
      predicted += raw_peak_probability(means, bin) / static_cast<double>(settings.pixels);
      seen += std::lround(found.errors[0][pixel] + found.places[pixel]) == static_cast<long>(bin) ? 1U : 0U;
    }
    const Estimate measured = estimate_share(seen, settings.pixels);
    held.push_back(measured.interval.low <= predicted && predicted <= measured.interval.high);
    texts.push_back(fmt::format("{:g} signal photons: {:.1f} %, counted {:.1f} % ({:.1f} to {:.1f})",
                                signal * photons.acquisitions, 100.0 * predicted, 100.0 * measured.value,
                                100.0 * measured.interval.low, 100.0 * measured.interval.high));
  }
  return {"the same", "The probability of detection of a raw peak has a semi-closed form",
          "32 bins, 200 background photons: probability that the bin with the largest mean is the highest "
          "one, within the 95 % interval of the counted share (the form is derived here; the paper's own is "
          "not known)",
          fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

/// Boundaries of 16 parts as exact as all timestamps tell them.
std::vector<double> exact_boundaries(std::span<const Detection> frame) {
  constexpr std::size_t kSixteen = 16;
  std::vector<double> times;
  for (const Detection& detection : frame) {
    times.push_back(detection.timestamp + 0.5);
  }
  std::ranges::sort(times);
  std::vector<double> boundaries;
  for (std::size_t i = 1; i < kSixteen && !times.empty(); ++i) {
    boundaries.push_back(times[times.size() * i / kSixteen]);
  }
  return boundaries;
}

PaperClaim free_running_boundaries(const PaperClaimSettings& settings) {
  constexpr double kInlier = 0.01;
  constexpr double kReliable = 0.9;
  FluxPhotons photons{.pulse_sigma = kPulseShare, .acquisitions = 3000, .dead_time = 0.75};
  const auto fit = std::make_shared<const EquiDepthFit>(photons.sensor(), Capture::kFreeRunning);
  const PlaceEstimator fitted = [fit](PixelFrames frames) {
    return fit->decode(exact_boundaries(frames.back())).position;
  };
  const PlaceEstimator narrowest = [codes = 1 << photons.np](PixelFrames frames) {
    return densest_place(exact_boundaries(frames.back()), codes).position;
  };
  const double limit = kInlier * std::ldexp(1.0, photons.np);
  std::vector<std::string> texts;
  std::vector<bool> held;
  for (const double background : {0.3, 1.0, 3.0}) {
    photons.background_events = background;
    photons.signal_events = 0.2 * background;
    const auto inliers = [&](FluxPhotons::Kept kept, const PlaceEstimator& estimator) {
      photons.kept = kept;
      return share_of(
          flux_errors(photons, {estimator}, settings.pixels, settings.seed, settings.threads).errors[0],
          limit);
    };
    const double own = inliers(FluxPhotons::Kept::kFreeRunning, fitted);
    const double unfitted = inliers(FluxPhotons::Kept::kFreeRunning, narrowest);
    const double armed = inliers(FluxPhotons::Kept::kSynchronous, narrowest);
    held.push_back(own > armed && own >= kReliable);
    texts.push_back(
        fmt::format("{:g}: {:.1f} % (narrowest part, free-running: {:.1f} %; narrowest part, armed at each "
                    "pulse: {:.1f} %)",
                    background, 100.0 * own, 100.0 * unfitted, 100.0 * armed));
  }
  return {"Sadekar, Goyal, Maier and Ingle, ICCP 2025 (arXiv 2608.18306)",
          "Free-running capture with analysis by synthesis measures distances over a wide range of light, "
          "in spite of dead time",
          "exact boundaries of 16 parts, dead time of 3/4 of the range; 0.3, 1 and 3 background photons a "
          "pulse, a fifth as many of the signal: share of pixels within 1 % of the range, at least 90 %, "
          "and more than the narrowest part finds if the SPAD is armed at each pulse",
          fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

/// A histogram of 32 bins that is swept over the range in four steps, each for a quarter of the frame.
std::vector<std::int32_t> swept_histogram(std::span<const Detection> frame, std::uint32_t acquisitions) {
  constexpr std::size_t kSteps = 4;
  constexpr std::size_t kBinCodes = 8;
  std::vector<std::int32_t> counts(1024 / kBinCodes, 0);
  for (const Detection& detection : frame) {
    const std::size_t bin = detection.timestamp / kBinCodes;
    const std::size_t step = std::size_t{detection.acquisition} * kSteps / acquisitions;
    counts[bin] += bin * kSteps / counts.size() == step ? 1 : 0;
  }
  return counts;
}

PaperClaim codes_beside_swept_histograms(const PaperClaimSettings& settings) {
  constexpr double kMostError = 0.35;
  std::vector<std::string> texts;
  std::vector<bool> held;
  for (const auto& [name, photons] : kTwoLights) {
    const SensorModel sensor = photons.sensor();
    const auto matcher = std::make_shared<const BinMatcher>(sensor, 128, 8);
    const PlaceEstimator highest = [all = photons.detections](PixelFrames frames) {
      const std::vector<std::int32_t> counts = swept_histogram(frames.back(), all);
      return 8.0 * (static_cast<double>(std::ranges::max_element(counts) - counts.begin()) + 0.5) - 0.5;
    };
    const PlaceEstimator matched = [matcher, all = photons.detections](PixelFrames frames) {
      return matcher->decode(swept_histogram(frames.back(), all)).position;
    };
    const PlaceEstimator code = estimator_of(make_linear_code(
        sensor, {.counters = 8,
                 .weights = wave_weights(sensor.np, waves_of(optimised_harmonics(sensor, 8)), 4),
                 .count_bits = 20,
                 .is_signed = true}));
    const PlaceErrors found =
        place_errors(photons, {code, highest, matched}, settings.pixels, settings.seed, settings.threads);
    std::array<double, 3> errors{};
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i] = estimate_root_mean_square(found.errors[i]).value;
    }
    held.push_back(errors[0] <= kMostError * errors[1]);
    held.push_back(errors[0] <= kMostError * errors[2]);
    texts.push_back(fmt::format("{}: {:.2f} times (matched filter: {:.2f})", name, errors[0] / errors[1],
                                errors[0] / errors[2]));
  }
  return {"Feng et al., IEEE Sensors Journal 2025 (doi 10.1109/JSEN.2025.3575784)",
          "Codes of 4 bits that are optimised by data have 65 % less error than a swept partial histogram "
          "at four times its compression",
          "optimised harmonics K = 8, this project's own code in place of the learned one, beside a "
          "32-bin histogram swept over the range in four steps, read by its highest bin and by a matched "
          "filter: at most 0.35 times the root mean square error",
          fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

/// Centre of mass of a histogram around its highest bin, without the mean of the bins more than `reach` codes
/// away.
double centre_of_mass(std::span<const Detection> frame, int np, double reach) {
  constexpr int kBinCodes = 8;
  std::vector<double> counts(static_cast<std::size_t>((1 << np) / kBinCodes), 0.0);
  for (const Detection& detection : frame) {
    counts[detection.timestamp / kBinCodes] += 1.0;
  }
  const auto bins = static_cast<std::ptrdiff_t>(std::lround(reach / kBinCodes));
  const auto best = std::ranges::max_element(counts) - counts.begin();
  const auto begin = counts.begin() + std::max<std::ptrdiff_t>(0, best - bins);
  const auto end = counts.begin() + std::min(std::ssize(counts), best + bins + 1);
  const double inside = std::accumulate(begin, end, 0.0);
  const auto width = static_cast<double>(end - begin);
  const double background =
      (static_cast<double>(frame.size()) - inside) / (static_cast<double>(counts.size()) - width);
  double moment = 0.0;
  for (auto bin = begin; bin != end; ++bin) {
    moment += (*bin - background) * static_cast<double>(bin - counts.begin());
  }
  return kBinCodes * (moment / (inside - width * background) + 0.5) - 0.5;
}

double mean_absolute(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double error : errors) {
    sum += std::abs(error) / static_cast<double>(errors.size());
  }
  return sum;
}

PaperClaim legendre_memory_beside_the_centre_of_mass(const PaperClaimSettings& settings) {
  constexpr double kLowerPrecision = 5.0;
  constexpr double kSimilar = 1.5;
  constexpr double kFullWidth = 2.354820045;  // at half maximum, in standard deviations
  std::vector<std::string> texts;
  std::vector<bool> held;
  for (const auto& [name, photons] : kTwoLights) {
    const double reach = kFullWidth * photons.pulse_sigma * std::ldexp(1.0, photons.np);
    const PlaceEstimator centre = [np = photons.np, reach](PixelFrames frames) {
      return centre_of_mass(frames.back(), np, reach);
    };
    const PlaceErrors found = place_errors(photons,
                                           {centre, estimator_of(make_legendre_memory(photons.sensor(), 8)),
                                            estimator_of(make_legendre_memory(photons.sensor(), 16))},
                                           settings.pixels, settings.seed, settings.threads);
    std::array<double, 3> deviations{};
    std::array<double, 3> means{};
    for (std::size_t i = 0; i < means.size(); ++i) {
      deviations[i] = estimate_standard_deviation(found.errors[i]).value;
      means[i] = mean_absolute(found.errors[i]);
    }
    for (std::size_t i = 1; i < means.size(); ++i) {
      held.push_back(deviations[i] <= kLowerPrecision * deviations[0]);
      held.push_back(means[i] <= kSimilar * means[0]);
    }
    texts.push_back(fmt::format(
        "{}: {:.2f} and {:.2f} times the standard deviation ({:.2f} codes), {:.2f} and {:.2f} times the mean "
        "absolute error ({:.2f} codes)",
        name, deviations[1] / deviations[0], deviations[2] / deviations[0], deviations[0],
        means[1] / means[0], means[2] / means[0], means[0]));
  }
  return {
      "MacLean, Stewart and Gyongy, arXiv 2401.10793",
      "A spiking network without TDC has five times lower precision than the centre of mass of a "
      "histogram, and a similar mean absolute error",
      "Legendre memories of the orders 8 and 16 (the abstract states no order), with a matched filter in "
      "place of the trained network and so at least as exact, beside the centre of mass of 128 bins within "
      "a pulse's full width at half maximum of the highest one: at most 5 times its standard deviation, "
      "at most 1.5 times its mean absolute error",
      fmt::format("{}. Neither has a systematic error here, so both ratios are alike; five times lower "
                  "precision with a similar error needs one in the centre of mass",
                  fmt::join(texts, "; ")),
      claim_verdict(held)};
}

}  // namespace

std::vector<PaperClaim> judge_recent_claims(const PaperClaimSettings& settings) {
  return {average_without_pile_up(settings),
          early_reports(settings),
          probability_of_a_raw_peak(settings),
          free_running_boundaries(settings),
          codes_beside_swept_histograms(settings),
          codes_with_the_laser(settings),
          legendre_memory_beside_the_centre_of_mass(settings)};
}

}  // namespace dtof
