// SPDX-License-Identifier: Apache-2.0
#include "rivals/joint_claim.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "dtof/metrics/error_estimates.hpp"
#include "rivals/joint_code.hpp"

namespace dtof {
namespace {

constexpr int kCodes = 1024;
constexpr std::size_t kCounters = 8;
constexpr double kBlur = 0.0189 * kCodes;  // the shortest pulse is the thesis's

/// Peak over mean power; the last one is no limit beside the low-pass.
constexpr std::array kPeaks = {5.0, 10.0, 30.0, double{kCodes}};

struct LitBy {
  std::string_view name;
  double detections;
  double signal_share;
};
/// Two of the photons of paper_claims.cpp.
constexpr std::array kLights = {LitBy{"even", 1000.0, 0.5}, LitBy{"sunlit", 10'000.0, 1.0 / 11.0}};

/// Errors of the codes under the same limits.
struct CodeErrors {
  Estimate joint;
  Estimate alone;        ///< best harmonics for the shortest pulse
  Estimate traditional;  ///< the better one of truncated Fourier and Gray-Fourier with the shortest pulse
};

CodeErrors errors_of(const LaserLimits& limits, const PaperClaimSettings& settings) {
  const auto error = [&](const LaserCode& code) {
    return estimate_root_mean_square(
        laser_code_errors(limits, code, settings.pixels, settings.seed, settings.threads));
  };
  const std::vector<double> pulse = shortest_pulse(limits);
  const Estimate fourier = error({pulse, {1, 2, 3, 4}});
  const Estimate gray = error({pulse, {1, 2, 4, 8}});
  return {error(joint_code(limits, kCounters, settings.seed)),
          error(best_code_of_the_shortest_pulse(limits, kCounters)),
          fourier.value < gray.value ? fourier : gray};
}

std::string name_of(double peak) {
  return peak < kCodes ? fmt::format("peak of {:g} times the mean", peak) : "low-pass alone";
}

}  // namespace

PaperClaim codes_with_the_laser(const PaperClaimSettings& settings) {
  std::vector<bool> held;
  std::vector<std::string> texts;
  for (const auto& [name, detections, signal_share] : kLights) {
    std::vector<std::string> by_peak;
    std::vector<double> ratios;
    for (const double peak : kPeaks) {
      const CodeErrors found = errors_of({.codes = kCodes,
                                          .blur = kBlur,
                                          .peak = peak,
                                          .detections = detections,
                                          .signal_share = signal_share},
                                         settings);
      held.push_back(found.joint.interval.high < found.traditional.interval.low);
      ratios.push_back(found.joint.value / found.traditional.value);
      by_peak.push_back(fmt::format("{}: {:.2f} times (harmonics alone: {:.2f})", name_of(peak),
                                    ratios.back(), found.alone.value / found.traditional.value));
    }
    held.push_back(ratios.front() < ratios.back());
    texts.push_back(fmt::format("{}: {}", name, fmt::join(by_peak, ", ")));
  }
  return {
      "Parra, Gutierrez-Barragan, Seets and Velten, TPAMI 2025 (arXiv 2510.12123)",
      "Codes that are optimised together with the laser's light are better than traditional codes under "
      "limits "
      "of bandwidth and of peak power, most of all under those of peak power",
      "eight numbers, found by the project's own search in place of the paper's network; the low-pass of the "
      "thesis's pulse: root mean square error beside the better one of truncated Fourier and Gray-Fourier "
      "codes "
      "with the shortest pulse that the limits allow, below it by more than both intervals; and a smaller "
      "ratio "
      "at a peak of 5 times the mean than with the low-pass alone",
      fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

}  // namespace dtof
