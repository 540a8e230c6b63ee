// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/cfar_detector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

constexpr std::int64_t kDeviations = 6;
constexpr std::int64_t kLeastMean = 2;
constexpr std::int32_t kGuardBins = 2;
constexpr std::int32_t kReferenceBins = 4;  // on each side

/// Sum and number of the reference bins.
struct Reference {
  std::int32_t sum = 0;
  std::int32_t bins = 0;
};

class CfarDetector final : public Rival {
 public:
  CfarDetector(const SensorModel& sensor, const CfarChoice& choice)
      : sensor_(sensor),
        choice_(choice),
        bins_(std::int32_t{1} << static_cast<unsigned>(choice.bin_bits)),
        shift_(static_cast<unsigned>(sensor.np - choice.bin_bits)),
        limit_((std::int32_t{1} << static_cast<unsigned>(choice.count_bits)) - 1) {}

  [[nodiscard]] int bits_per_pixel() const override {
    return bins_ * choice_.count_bits + (choice_.early ? 1 : 0);
  }
  /// Early reports: the reference bins are summed, and two products are compared. All bins are read at once.
  [[nodiscard]] RivalHardware hardware() const override {
    if (!choice_.early) {
      return {.words = bins_, .word_bits = choice_.count_bits};
    }
    const int sum_bits = choice_.count_bits + 3;
    return {.word_bits = bits_per_pixel(),
            .adder_bits = 2 * kReferenceBins * sum_bits + sum_bits * sum_bits + 6 * sum_bits};
  }
  [[nodiscard]] int host_operations() const override { return 10; }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    const int no_detection = (1 << sensor_.np) - 1;
    std::vector<std::int32_t> counts(static_cast<std::size_t>(bins_), 0);
    for (const Detection& detection : frames.back()) {
      if (detection.timestamp == no_detection) {
        continue;
      }
      const auto bin = static_cast<std::int32_t>(detection.timestamp >> shift_);
      std::int32_t& count = counts[static_cast<std::size_t>(bin)];
      if (count == limit_) {
        break;
      }
      ++count;
      if (choice_.early && is_peak(counts, bin)) {
        return report(counts, bin, detection.acquisition);
      }
    }
    const auto highest = std::ranges::max_element(counts) - counts.begin();
    return report(counts, static_cast<std::int32_t>(highest), sensor_.acquisitions);
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    const double background = static_cast<double>(words[4]) / words[5];
    double all = 0.0;
    double moment = 0.0;
    for (int side = -1; side <= 1; ++side) {
      const double excess = std::max(0.0, words[static_cast<std::size_t>(2 + side)] - background);
      all += excess;
      moment += side * excess;
    }
    const double width = std::ldexp(1.0, static_cast<int>(shift_));
    const double place = (words[0] + 0.5 + (all > 0.0 ? moment / all : 0.0)) * width - 0.5;
    const double noise = std::sqrt(std::max(background, static_cast<double>(kLeastMean)));
    return {std::clamp(place, 0.0, std::ldexp(1.0, sensor_.np) - 2.0),
            std::max(0.0, words[2] - background) / noise};
  }

 private:
  [[nodiscard]] Reference reference(const std::vector<std::int32_t>& counts, std::int32_t bin) const {
    Reference reference;
    for (std::int32_t away = kGuardBins + 1; away <= kGuardBins + kReferenceBins; ++away) {
      for (const std::int32_t other : {bin - away, bin + away}) {
        if (other >= 0 && other < bins_) {
          reference.sum += counts[static_cast<std::size_t>(other)];
          ++reference.bins;
        }
      }
    }
    return reference;
  }

  /// The threshold times m, without a quotient.
  [[nodiscard]] bool is_peak(const std::vector<std::int32_t>& counts, std::int32_t bin) const {
    const Reference around = reference(counts, bin);
    const std::int64_t m = around.bins;
    const std::int64_t excess = m * counts[static_cast<std::size_t>(bin)] - around.sum;
    const std::int64_t spread = m * std::max<std::int64_t>(around.sum, kLeastMean * m);
    return excess > 0 && excess * excess >= kDeviations * kDeviations * spread;
  }

  [[nodiscard]] RivalWords report(const std::vector<std::int32_t>& counts, std::int32_t bin,
                                  std::uint32_t acquisition) const {
    const Reference around = reference(counts, bin);
    const auto count = [&](std::int32_t at) {
      return at >= 0 && at < bins_ ? counts[static_cast<std::size_t>(at)] : 0;
    };
    return {bin,
            count(bin - 1),
            count(bin),
            count(bin + 1),
            around.sum,
            around.bins,
            static_cast<std::int32_t>(acquisition)};
  }

  SensorModel sensor_;
  CfarChoice choice_;
  std::int32_t bins_;
  unsigned shift_;
  std::int32_t limit_;
};

}  // namespace

std::unique_ptr<Rival> make_cfar_detector(const SensorModel& sensor, const CfarChoice& choice) {
  if (choice.bin_bits < 4 || choice.bin_bits > sensor.np || choice.count_bits < 4 || choice.count_bits > 16) {
    throw InputError(
        fmt::format("CFAR detector: 2^{} bins of {} bits, but it must be 2^4 to 2^NP bins of 4 to 16",
                    choice.bin_bits, choice.count_bits));
  }
  return std::make_unique<CfarDetector>(sensor, choice);
}

double raw_peak_probability(std::span<const double> means, std::size_t peak) {
  // P(y = n) and P(y < n) of each bin, for one n after the other.
  std::vector<double> equal(means.size());
  std::ranges::transform(means, equal.begin(), [](double mean) { return std::exp(-mean); });
  std::vector<double> below(means.size(), 0.0);
  const double most = means[peak] + 12.0 * std::sqrt(means[peak]) + 30.0;
  double probability = 0.0;
  for (int n = 0; n <= most; ++n) {
    double others = 1.0;
    for (std::size_t j = 0; j < means.size(); ++j) {
      if (j != peak) {
        others *= j < peak ? below[j] : below[j] + equal[j];
      }
    }
    probability += equal[peak] * others;
    for (std::size_t j = 0; j < means.size(); ++j) {
      below[j] += equal[j];
      equal[j] *= means[j] / (n + 1);
    }
  }
  return probability;
}

}  // namespace dtof
