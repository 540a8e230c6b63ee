// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/coarse_histogram.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "dtof/core/error.hpp"
#include "dtof/rival/bin_matcher.hpp"

namespace dtof {
namespace {

class CoarseHistogram final : public Rival {
 public:
  CoarseHistogram(const SensorModel& sensor, const CoarseHistogramChoice& choice)
      : sensor_(sensor),
        choice_(choice),
        bins_(std::size_t{1} << static_cast<unsigned>(choice.bin_bits)),
        shift_(static_cast<unsigned>(sensor.np - choice.bin_bits)),
        limit_((std::int32_t{1} << static_cast<unsigned>(choice.count_bits)) - 1),
        matcher_(sensor, static_cast<int>(bins_), 1 << shift_) {}

  [[nodiscard]] int bits_per_pixel() const override { return static_cast<int>(bins_) * choice_.count_bits; }

  [[nodiscard]] RivalHardware hardware() const override {
    return {.words = static_cast<int>(bins_), .word_bits = choice_.count_bits};
  }
  [[nodiscard]] int host_operations() const override { return matcher_.operations(); }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    const int no_detection = (1 << sensor_.np) - 1;
    RivalWords counts(bins_, 0);
    for (const Detection& detection : frames.back()) {
      if (detection.timestamp == no_detection) {
        continue;
      }
      std::int32_t& count = counts[static_cast<std::size_t>(detection.timestamp) >> shift_];
      count += count < limit_ ? 1 : 0;
    }
    return counts;
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return matcher_.decode(words);
  }

  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const override {
    std::vector<double> scores = matcher_.scores(words);
    scores.pop_back();  // the no-detection code
    return scores;
  }

 private:
  SensorModel sensor_;
  CoarseHistogramChoice choice_;
  std::size_t bins_;
  unsigned shift_;
  std::int32_t limit_;
  BinMatcher matcher_;
};

}  // namespace

std::unique_ptr<Rival> make_coarse_histogram(const SensorModel& sensor, const CoarseHistogramChoice& choice) {
  if (choice.bin_bits < 2 || choice.bin_bits > sensor.np || choice.count_bits < 1 || choice.count_bits > 16) {
    throw InputError(
        fmt::format("coarse histogram: 2^{} bins of {} bits, but it must be 2^2 to 2^NP bins of 1 to 16",
                    choice.bin_bits, choice.count_bits));
  }
  return std::make_unique<CoarseHistogram>(sensor, choice);
}

}  // namespace dtof
