// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/guided_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"
#include "dtof/rival/bin_matcher.hpp"

namespace dtof {
namespace {

constexpr std::int32_t kBins = 8;

class GuidedWindow final : public Rival {
 public:
  GuidedWindow(const SensorModel& sensor, const GuidedWindowChoice& choice)
      : sensor_(sensor),
        choice_(choice),
        codes_(std::int32_t{1} << static_cast<unsigned>(sensor.np)),
        wide_(sensor, kBins, codes_ / 32),
        narrow_(sensor, kBins, codes_ / 64) {}

  [[nodiscard]] int bits_per_pixel() const override { return kBins * choice_.count_bits + sensor_.np; }
  [[nodiscard]] int frames() const override { return 3; }
  /// The guide is one more word; its difference from the timestamp is the sum.
  [[nodiscard]] RivalHardware hardware() const override {
    return {
        .words = kBins + 1, .word_bits = std::max(choice_.count_bits, sensor_.np), .adder_bits = sensor_.np};
  }
  [[nodiscard]] int host_operations() const override { return narrow_.operations(); }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    const std::int32_t coarse_width = codes_ / kBins;
    const RivalWords coarse = count(frames[0], 0, coarse_width);
    const auto highest = static_cast<std::int32_t>(
        std::ranges::max_element(coarse.begin() + 1, coarse.end()) - coarse.begin() - 1);
    const RivalWords around =
        count(frames[1], begin_of(highest * coarse_width + coarse_width / 2, codes_ / 32), codes_ / 32);
    const Measurement found = wide_.decode(std::span(around).subspan(1));
    const auto guide = around[0] + static_cast<std::int32_t>(std::lround(found.position));
    return count(frames[2], begin_of(guide, codes_ / 64), codes_ / 64);
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    const Measurement found = narrow_.decode(words.subspan(1));
    return {words[0] + found.position, found.confidence};
  }

  [[nodiscard]] std::vector<double> evidence(std::span<const std::int32_t> words) const override {
    std::vector<double> all(static_cast<std::size_t>(codes_), 0.0);
    const std::vector<double> inside = narrow_.scores(words.subspan(1));
    std::ranges::copy(inside, all.begin() + words[0]);
    all.pop_back();  // the no-detection code
    return all;
  }

 private:
  [[nodiscard]] std::int32_t begin_of(std::int32_t centre, std::int32_t width) const {
    return std::clamp(centre - kBins / 2 * width, 0, codes_ - kBins * width);
  }

  [[nodiscard]] RivalWords count(std::span<const Detection> detections, std::int32_t begin,
                                 std::int32_t width) const {
    check_rival_frame(detections, sensor_);
    const std::int32_t limit = (std::int32_t{1} << static_cast<unsigned>(choice_.count_bits)) - 1;
    RivalWords words(kBins + 1, 0);
    words[0] = begin;
    for (const Detection& detection : detections) {
      const std::int32_t inside = std::int32_t{detection.timestamp} - begin;
      if (detection.timestamp != codes_ - 1 && inside >= 0 && inside < kBins * width) {
        std::int32_t& bin = words.at(1 + static_cast<std::size_t>(inside / width));
        bin += bin < limit ? 1 : 0;
      }
    }
    return words;
  }

  SensorModel sensor_;
  GuidedWindowChoice choice_;
  std::int32_t codes_;
  BinMatcher wide_;
  BinMatcher narrow_;
};

}  // namespace

std::unique_ptr<Rival> make_guided_window(const SensorModel& sensor, const GuidedWindowChoice& choice) {
  if (choice.count_bits < 1 || choice.count_bits > 16 || sensor.np < 6) {
    throw InputError(
        fmt::format("guided window: bins of {} bits at NP = {}, but it must be 1 to 16 and at least 6",
                    choice.count_bits, sensor.np));
  }
  return std::make_unique<GuidedWindow>(sensor, choice);
}

}  // namespace dtof
