// SPDX-License-Identifier: Apache-2.0
#include "dtof/design/bench_counts.hpp"

#include <cmath>

#include "dtof/core/error.hpp"

namespace dtof {

std::uint32_t sky_frames(const BenchSettings& settings, std::size_t pixels) {
  constexpr double kSkyPixelsPassing = 10.0;  // at least, in the mean, at the threshold
  return static_cast<std::uint32_t>(
      std::ceil(kSkyPixelsPassing / settings.false_alarms / static_cast<double>(pixels)));
}

void FrameCounts::add(const ErrorStatistics& errors, double mean_square) {
  if (errors.count() == 0) {
    return;
  }
  const ErrorSummary summary = errors.summary();
  const auto count = static_cast<double>(summary.count);
  pixels += summary.count;
  above_3 += static_cast<std::uint64_t>(std::llround(summary.share_above_3_percent * count));
  above_10 += static_cast<std::uint64_t>(std::llround(summary.share_above_10_percent * count));
  squares += mean_square * count;
}

void LightCounts::add(const FrameCounts& frame) {
  if (frame.pixels == 0) {
    throw InputError("design: no pixel of the scenes can be judged");
  }
  const auto pixels = static_cast<double>(frame.pixels);
  above_3_.push_back(static_cast<double>(frame.above_3) / pixels);
  above_10_.push_back(static_cast<double>(frame.above_10) / pixels);
  detected_.push_back(static_cast<double>(frame.detected) / pixels);
  squares_ += frame.squares;
  pixels_ += frame.pixels;
}

Estimate LightCounts::share(const std::vector<double>& frames) const {
  return frames.size() > 1
             ? estimate_share_of_frames(frames, pixels())
             : estimate_share(
                   static_cast<std::uint64_t>(std::llround(frames.front() * static_cast<double>(pixels()))),
                   pixels());
}

LightScore LightCounts::score(double klux, bool detection) const {
  LightScore light{.klux = klux,
                   .above_3_percent = share(above_3_),
                   .above_3_of_frames = above_3_,
                   .above_10_percent = share(above_10_),
                   .rmse_m = std::sqrt(squares_ / static_cast<double>(pixels_)),
                   .detected = std::nullopt,
                   .false_alarms = std::nullopt};
  if (detection) {
    light.detected = share(detected_);
  }
  return light;
}

}  // namespace dtof
