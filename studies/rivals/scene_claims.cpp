// SPDX-License-Identifier: Apache-2.0
#include "rivals/scene_claims.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

namespace dtof {
namespace {

/// Root mean square of the error by where the pulse lies in its bin, in eight classes: the largest over the
/// least.
double spread_over_places(const PlaceErrors& found, std::size_t estimator, double bin_codes) {
  constexpr std::size_t kClasses = 8;
  std::array<double, kClasses> squares{};
  std::array<double, kClasses> counts{};
  for (std::size_t pixel = 0; pixel < found.places.size(); ++pixel) {
    const double inside = (found.places[pixel] + 0.5) / bin_codes;
    const auto place = std::min(kClasses - 1, static_cast<std::size_t>((inside - std::floor(inside)) *
                                                                       static_cast<double>(kClasses)));
    squares[place] += found.errors[estimator][pixel] * found.errors[estimator][pixel];
    counts[place] += 1.0;
  }
  for (std::size_t place = 0; place < kClasses; ++place) {
    squares[place] /= std::max(1.0, counts[place]);
  }
  const auto [least, largest] = std::ranges::minmax(squares);
  return std::sqrt(largest / least);
}

std::size_t index_of(const PaperScene& scene, std::string_view name) {
  const auto found = std::ranges::find(scene.codes, name, &CodePrecision::code);
  if (found == scene.codes.end()) {
    throw std::logic_error(fmt::format("no code '{}' on the {} photons", name, scene.name));
  }
  return static_cast<std::size_t>(found - scene.codes.begin());
}

/// One scene's figure after the other.
template <typename Figure>
std::string by_scene(std::span<const PaperScene> scenes, const Figure& figure) {
  std::vector<std::string> texts;
  for (const PaperScene& scene : scenes) {
    texts.push_back(fmt::format("{}: {}", scene.name, figure(scene)));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

/// The code of a family with the fewest values among those that lose at most a tenth of the full histogram's
/// precision.
std::optional<CodePrecision> smallest_without_loss(const PaperScene& scene,
                                                   std::span<const std::string_view> families) {
  std::optional<CodePrecision> best;
  for (const CodePrecision& code : scene.codes) {
    const bool of_family = std::ranges::find(families, code.family) != families.end();
    if (of_family && scene.ratio(code.code, kFull) <= kNegligibleLoss &&
        (!best || code.values < best->values)) {
      best = code;
    }
  }
  return best;
}

PaperClaim sketches_reach_the_bound(std::span<const PaperScene> scenes) {
  constexpr int kModest = 16;
  std::vector<std::string> texts;
  std::vector<bool> held;
  for (const PaperScene& scene : scenes) {
    const auto reached = std::ranges::find_if(scene.codes, [&](const CodePrecision& code) {
      return code.family == "sketch" && code.rmse.value <= kNegligibleLoss * scene.bound;
    });
    if (reached == scene.codes.end()) {
      held.push_back(false);
      texts.push_back(fmt::format("{}: none of those tried", scene.name));
      continue;
    }
    held.push_back(reached->values <= 2 * kModest);
    texts.push_back(fmt::format("{}: M = {} ({:.2f} times the bound)", scene.name, reached->values / 2,
                                reached->rmse.value / scene.bound));
  }
  return {
      "Sheehan, Tachella and Davies, IEEE TCI 2021 (arXiv 2102.08732)",
      "The mean squared error comes quickly to the Cramer-Rao bound as the sketch grows, for modest sizes",
      fmt::format("smallest sketch whose error is at most {:.0f} % above the bound; modest: M up to {}",
                  100.0 * (kNegligibleLoss - 1.0), kModest),
      fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

PaperClaim sketches_compress(const PaperScene& fine) {
  constexpr std::string_view kCode = "sketch M = 13";
  const double compression =
      static_cast<double>(fine.code(kFull).values) / static_cast<double>(fine.code(kCode).values);
  const double ratio = fine.ratio(kCode, kFull);
  return {"the same", "Compression up to 150 without loss of the image's resolution",
          "error of M = 13 beside the full histogram of 4096 bins",
          fmt::format("compression {:.0f}: {:.2f} times the full histogram's error", compression, ratio),
          claim_verdict({compression >= 150.0 && ratio <= kNegligibleLoss})};
}

PaperClaim splines_compress(std::span<const PaperScene> scenes) {
  constexpr std::string_view kCode = "spline sketch m = 51";
  std::vector<bool> held;
  for (const PaperScene& scene : scenes) {
    held.push_back(scene.ratio(kCode, kFull) <= kNegligibleLoss);
  }
  return {"Sheehan, Tachella and Davies, IEEE TCI 2022 (arXiv 2210.07314)",
          "Linear splines lose a negligible part of the resolution at 95 % compression",
          "error of 51 knots beside the full histogram of 1024 bins",
          by_scene(scenes,
                   [&](const PaperScene& scene) {
                     return fmt::format("{:.2f} times", scene.ratio(kCode, kFull));
                   }),
          claim_verdict(held)};
}

PaperClaim splines_are_even(const PaperScene& narrow, const PlaceErrors& found) {
  const double spline = spread_over_places(found, index_of(narrow, "spline sketch m = 32"), 32.0);
  const double bins = spread_over_places(found, index_of(narrow, "32 bins, matched"), 32.0);
  return {"the same", "Coarse bins are not equally exact everywhere, splines are",
          "32 counters each, narrow pulse: the error where it is largest in a bin over where it is least, at "
          "most 2 for splines and more than twice that for bins",
          fmt::format("splines {:.1f}, bins {:.1f}", spline, bins),
          claim_verdict({spline <= 2.0 && bins > 2.0 * spline})};
}

PaperClaim codes_compress(std::span<const PaperScene> scenes) {
  constexpr std::array<std::string_view, 2> kFamilies = {"truncated Fourier", "Gray-Fourier"};
  std::vector<bool> held;
  std::vector<std::string> texts;
  for (const PaperScene& scene : scenes) {
    const std::optional<CodePrecision> best = smallest_without_loss(scene, kFamilies);
    const double compression =
        best ? static_cast<double>(scene.code(kFull).values) / static_cast<double>(best->values) : 0.0;
    held.push_back(compression >= 10.0);
    texts.push_back(best ? fmt::format("{}: {:.0f} ({}, {:.2f} times the error)", scene.name, compression,
                                       best->code, scene.ratio(best->code, kFull))
                         : fmt::format("{}: none of those tried", scene.name));
  }
  return {
      "Gutierrez-Barragan et al., CVPR 2022",
      "Well-chosen codes send one to two orders of magnitude less data without loss of depth precision",
      fmt::format("largest compression, in numbers for each pixel, with at most {:.0f} % more error than the "
                  "full histogram; at least 10",
                  100.0 * (kNegligibleLoss - 1.0)),
      fmt::format("{}", fmt::join(texts, "; ")), claim_verdict(held)};
}

PaperClaim binners_converge(const PaperScene& even, const PlaceErrors& found) {
  const std::vector<double>& binner = found.errors[index_of(even, "HEDH-2")];
  const std::vector<double>& median = found.errors[index_of(even, "exact equi-depth, 2 bins")];
  std::vector<double> apart;
  for (std::size_t pixel = 0; pixel < binner.size(); ++pixel) {
    apart.push_back(std::abs(binner[pixel] - median[pixel]));
  }
  std::ranges::sort(apart);
  const double middle = apart[apart.size() / 2];
  const double most = apart[apart.size() * 95 / 100];
  const double sigma = even.photons.pulse_sigma * std::ldexp(1.0, even.photons.np);
  return {
      "Ingle and Maier, TPAMI 2023 (arXiv 2307.04924)", "A binner converges on the median of its photons",
      "even photons: how far the binner is from the median of all its timestamps; half of the pixels within "
      "half, 95 % within one standard deviation of the pulse",
      fmt::format("half within {:.1f}, 95 % within {:.1f} codes (the pulse's standard deviation has {:.1f})",
                  middle, most, sigma),
      claim_verdict({middle <= 0.5 * sigma, most <= sigma})};
}

PaperClaim binners_save_bandwidth(std::span<const PaperScene> scenes) {
  constexpr std::string_view kCode = "HEDH-64";
  constexpr double kSimilar = 1.5;
  const auto compression = [&](const PaperScene& scene) {
    return static_cast<double>(scene.code(kFullPeak).bits) / static_cast<double>(scene.code(kCode).bits);
  };
  std::vector<bool> held;
  for (const PaperScene& scene : scenes) {
    held.push_back(scene.ratio(kCode, kFullPeak) <= kSimilar && compression(scene) >= 10.0);
  }
  return {"the same", "At least an order of magnitude less bandwidth at similar accuracy of distances",
          fmt::format(
              "HEDH-64 ({} bits) beside the highest of 1024 bins ({} bits); similar: at most {} times its "
              "error",
              scenes.front().code(kCode).bits, scenes.front().code(kFullPeak).bits, kSimilar),
          by_scene(scenes,
                   [&](const PaperScene& scene) {
                     return fmt::format(
                         "{:.2f} times (with the matched filter for the full histogram: {:.0f})",
                         scene.ratio(kCode, kFullPeak), scene.ratio(kCode, kFull));
                   }),
          claim_verdict(held)};
}

PaperClaim equal_depth_beats_equal_width(std::span<const PaperScene> scenes) {
  constexpr std::string_view kDepth = "exact equi-depth, 16 bins";
  constexpr std::string_view kWidth = "16 bins, highest";
  std::vector<bool> held;
  for (const PaperScene& scene : scenes) {
    held.push_back(scene.ratio(kDepth, kWidth) < 1.0);
  }
  return {"Sadekar, Maier and Ingle, ECCV 2024 (arXiv 2408.16150)",
          "Equi-depth histograms tell more than equi-width ones of as many bins",
          "16 bins each: error of exact boundaries beside the highest of equal bins",
          by_scene(scenes,
                   [&](const PaperScene& scene) {
                     return fmt::format("{:.2f} times (equal bins with a matched filter: {:.2f})",
                                        scene.ratio(kDepth, kWidth), scene.ratio("16 bins, matched", kWidth));
                   }),
          claim_verdict(held)};
}

PaperClaim proportional_binners_suffice(std::span<const PaperScene> scenes) {
  constexpr std::string_view kBinners = "PEDH-16 optimised";
  constexpr std::string_view kWidth = "16 bins, highest";
  std::vector<bool> held;
  for (const PaperScene& scene : scenes) {
    held.push_back(scene.ratio(kBinners, kWidth) < 1.0);
  }
  return {"the same", "Binners find the boundaries while photons arrive, without keeping any timestamp",
          "PEDH-16 optimised: error beside the highest of 16 equal bins, and beside exact boundaries",
          by_scene(scenes,
                   [&](const PaperScene& scene) {
                     return fmt::format("{:.2f} and {:.2f} times", scene.ratio(kBinners, kWidth),
                                        scene.ratio(kBinners, "exact equi-depth, 16 bins"));
                   }),
          claim_verdict(held)};
}

PaperClaim online_em_compresses(std::span<const PaperScene> scenes) {
  constexpr std::string_view kCode = "online EM";
  std::vector<bool> held;
  for (const PaperScene& scene : scenes) {
    held.push_back(scene.ratio(kCode, kFullPeak) <= 1.0);
  }
  const double share = 100.0 * scenes.front().code(kCode).bits / scenes.front().code(kFull).bits;
  return {
      "Poisson, Guicquero, Coriat and Sicard (CEA-Leti)",
      "At 0.4 % of a histogram's data the timing resolution is not sacrificed",
      fmt::format("{:.1f} % of the full histogram's bits: no larger an error than the highest of 1024 bins",
                  share),
      by_scene(scenes,
               [&](const PaperScene& scene) {
                 return fmt::format("{:.2f} times (matched filter: {:.1f}; {:.1f} % of the pixels lost)",
                                    scene.ratio(kCode, kFullPeak), scene.ratio(kCode, kFull),
                                    100.0 * scene.code(kCode).lost);
               }),
      claim_verdict(held)};
}

}  // namespace

const CodePrecision& PaperScene::code(std::string_view wanted) const {
  return codes[index_of(*this, wanted)];
}

double PaperScene::ratio(std::string_view wanted, std::string_view other) const {
  return code(wanted).rmse.value / code(other).rmse.value;
}

std::vector<PaperClaim> claims_of_scenes(std::span<const PaperScene> scenes, const PlaceErrors& even,
                                         const PlaceErrors& narrow) {
  const std::span<const PaperScene> coarse = scenes.first(3);
  return {sketches_reach_the_bound(coarse),
          sketches_compress(scenes.back()),
          splines_compress(coarse),
          splines_are_even(scenes[2], narrow),
          codes_compress(coarse),
          binners_converge(scenes[0], even),
          binners_save_bandwidth(coarse),
          equal_depth_beats_equal_width(coarse),
          proportional_binners_suffice(coarse),
          online_em_compresses(coarse)};
}

}  // namespace dtof
