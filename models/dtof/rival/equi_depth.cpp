// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/equi_depth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

/// Calls `cycle(acquisition, timestamps)` for each acquisition that has detections.
template <typename Cycle>
void for_each_cycle(std::span<const Detection> detections, Timestamp no_detection, const Cycle& cycle) {
  std::vector<std::int32_t> timestamps;
  for (std::size_t i = 0; i < detections.size();) {
    const std::uint32_t acquisition = detections[i].acquisition;
    timestamps.clear();
    for (; i < detections.size() && detections[i].acquisition == acquisition; ++i) {
      if (detections[i].timestamp != no_detection) {
        timestamps.push_back(detections[i].timestamp);
      }
    }
    if (!timestamps.empty()) {
      cycle(acquisition, std::span<const std::int32_t>(timestamps));
    }
  }
}

constexpr int kOperationsOfAPart = 8;  // sorting, widths, the narrowest one

void check_parts(int parts) {
  if (parts < 2 || parts > 64 || !std::has_single_bit(static_cast<unsigned>(parts))) {
    throw InputError(fmt::format("equi-depth: {} parts, but it must be a power of two from 2 to 64", parts));
  }
}

Timestamp no_detection_of(const SensorModel& sensor) { return static_cast<Timestamp>((1 << sensor.np) - 1); }

/// Nearest, halves away from zero; `shift` > 0.
constexpr std::int64_t rounded_shift(std::int64_t value, unsigned shift) {
  const std::int64_t half = std::int64_t{1} << (shift - 1);
  return value >= 0 ? (value + half) >> shift : -((-value + half) >> shift);
}

class Hierarchical final : public Rival {
 public:
  Hierarchical(SensorModel sensor, int parts)
      : sensor_(std::move(sensor)),
        parts_(static_cast<std::size_t>(parts)),
        levels_(std::bit_width(parts_) - 1) {}

  [[nodiscard]] int bits_per_pixel() const override { return (static_cast<int>(parts_) - 1) * sensor_.np; }
  /// The boundaries of the last level, half of all, are compared with the timestamp.
  [[nodiscard]] RivalHardware hardware() const override {
    return {.word_bits = bits_per_pixel(), .adder_bits = static_cast<int>(parts_) / 2 * sensor_.np};
  }
  [[nodiscard]] int host_operations() const override { return kOperationsOfAPart * static_cast<int>(parts_); }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    // Boundary i of 1 .. parts - 1 belongs to the level of its lowest set bit; 0 and `parts` are the range's
    // ends.
    RivalWords boundaries(parts_ + 1, 0);
    boundaries.back() = 1 << sensor_.np;
    std::size_t level = 0;
    place(boundaries, level);
    for_each_cycle(
        frames.back(), no_detection_of(sensor_),
        [&](std::uint32_t acquisition, std::span<const std::int32_t> timestamps) {
          while (std::uint64_t{acquisition} * levels_ >= (level + 1) * std::uint64_t{sensor_.acquisitions}) {
            place(boundaries, ++level);
          }
          move(boundaries, level, timestamps);
        });
    while (level + 1 < levels_) {
      place(boundaries, ++level);
    }
    return {boundaries.begin() + 1, boundaries.end() - 1};
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    return densest_place({words.begin(), words.end()}, 1 << sensor_.np);
  }

 private:
  [[nodiscard]] std::size_t step(std::size_t level) const { return parts_ >> level; }

  void place(RivalWords& boundaries, std::size_t level) const {
    const std::size_t half = step(level) / 2;
    for (std::size_t i = half; i < parts_; i += 2 * half) {
      boundaries[i] = (boundaries[i - half] + boundaries[i + half]) / 2;
    }
  }

  void move(RivalWords& boundaries, std::size_t level, std::span<const std::int32_t> timestamps) const {
    const std::size_t half = step(level) / 2;
    for (std::size_t i = half; i < parts_; i += 2 * half) {
      const std::int32_t left = boundaries[i - half];
      const std::int32_t right = boundaries[i + half];
      int excess = 0;  // L - E
      for (const std::int32_t x : timestamps) {
        if (x >= left && x < right) {
          excess += x < boundaries[i] ? -1 : 1;
        }
      }
      const std::int32_t moved = boundaries[i] + (excess > 0 ? 1 : excess < 0 ? -1 : 0);
      if (moved > left && moved < right) {
        boundaries[i] = moved;
      }
    }
  }

  SensorModel sensor_;
  std::size_t parts_;
  std::size_t levels_;
};

class Proportional final : public Rival {
 public:
  Proportional(SensorModel sensor, const ProportionalChoice& choice)
      : sensor_(std::move(sensor)), parts_(choice.parts), optimised_(choice.optimised) {
    constexpr double kLeast = 0.02;
    constexpr double kFallsOver = 0.8;
    for (std::size_t step = 0; step < fall_.size(); ++step) {
      const double frame = static_cast<double>(step) / static_cast<double>(fall_.size());
      fall_[step] = std::lround(kOne * std::max(kLeast, std::pow(kLeast, frame / kFallsOver)));
    }
  }

  [[nodiscard]] int bits_per_pixel() const override {
    constexpr int kMomentumBits = 10 + 14;
    return (parts_ - 1) * (sensor_.np + fraction_bits() + (optimised_ ? kMomentumBits : 0));
  }

  /// Each boundary is compared with the timestamp and moved by a quotient whose divisor is a power of two;
  /// the optimised one has four products: 51 times the lag, 819 and the gain times a step, and all of it
  /// times D.
  [[nodiscard]] RivalHardware hardware() const override {
    constexpr int kProducts = 6 * 10 + 10 * 14 + 10 * 10 + 10 * 24;
    return {.word_bits = bits_per_pixel(),
            .adder_bits = (parts_ - 1) * (2 * sensor_.np + (optimised_ ? kProducts : 0))};
  }
  [[nodiscard]] int host_operations() const override { return kOperationsOfAPart * parts_; }

  [[nodiscard]] RivalWords read_pixel(PixelFrames frames) const override {
    check_rival_frame(frames.back(), sensor_);
    std::vector<Binner> binners;
    for (int i = 1; i < parts_; ++i) {
      binners.push_back({.boundary = i * ((std::int32_t{1} << sensor_.np) / parts_) << fraction_bits(),
                         .momentum = 0,
                         .step = 0});
    }
    for_each_cycle(frames.back(), no_detection_of(sensor_),
                   [&](std::uint32_t acquisition, std::span<const std::int32_t> timestamps) {
                     const std::int64_t fall = fall_[static_cast<std::size_t>(
                         std::uint64_t{acquisition} * fall_.size() / sensor_.acquisitions)];
                     for (std::size_t i = 0; i < binners.size(); ++i) {
                       move(binners[i], static_cast<int>(i) + 1, fall, timestamps);
                     }
                   });
    RivalWords words;
    for (const Binner& binner : binners) {
      words.push_back(binner.boundary);
    }
    return words;
  }

  [[nodiscard]] Measurement decode(std::span<const std::int32_t> words) const override {
    std::vector<double> boundaries;
    for (const std::int32_t word : words) {
      boundaries.push_back(std::ldexp(word, -fraction_bits()));
    }
    return densest_place(std::move(boundaries), 1 << sensor_.np);
  }

 private:
  struct Binner {
    std::int32_t boundary;  ///< e
    std::int32_t momentum;  ///< m, 9 fraction bits
    std::int32_t step;      ///< s, 8 fraction bits
  };
  static constexpr int kMomentumFraction = 9;
  static constexpr double kOne = 1024.0;  // of the shares below

  [[nodiscard]] int fraction_bits() const { return optimised_ ? 8 : 6; }

  void move(Binner& binner, int number, std::int64_t fall, std::span<const std::int32_t> timestamps) const {
    const auto early = static_cast<std::int32_t>(std::ranges::count_if(
        timestamps, [&](std::int32_t x) { return x << fraction_bits() < binner.boundary; }));
    const auto all = static_cast<std::int32_t>(timestamps.size());
    // d = (i L - (n - i) E) / (n (L + E)), rounded towards zero.
    const std::int32_t excess = number * (all - early) - (parts_ - number) * early;
    const auto deviation = [&](int bits) { return (excess << bits) / (parts_ * all); };
    if (!optimised_) {
      move_to(binner, binner.boundary + deviation(fraction_bits()));
      return;
    }
    constexpr std::int64_t kMomentumShare = 51;  // .05 in 1024ths
    constexpr std::int64_t kStepShare = 819;     // .8
    const std::int64_t gain =
        (std::int64_t{6144} << static_cast<unsigned>(sensor_.np)) / 1000;  // .2 * 3 B / 100
    const std::int64_t lag = std::int64_t{deviation(kMomentumFraction)} - binner.momentum;
    binner.momentum = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(binner.momentum + rounded_shift(kMomentumShare * lag, 10), -511, 511));
    // The momentum has one fraction bit more than the step; shares and D have 10 each.
    const std::int64_t sum = gain * binner.momentum + 2 * kStepShare * binner.step;
    binner.step =
        static_cast<std::int32_t>(std::clamp<std::int64_t>(rounded_shift(sum * fall, 21), -8191, 8191));
    move_to(binner, binner.boundary + binner.step);
  }

  void move_to(Binner& binner, std::int32_t boundary) const {
    const std::int32_t most = (std::int32_t{1} << (sensor_.np + fraction_bits())) - 1;
    binner.boundary = std::clamp(boundary, 0, most);
  }

  SensorModel sensor_;
  int parts_;
  bool optimised_;
  std::array<std::int64_t, 64> fall_{};
};

/// Top of the parabola through three points of ascending x; the middle one if it is no peak.
double parabola_top(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  const double left = (y[1] - y[0]) / (x[1] - x[0]);
  const double right = (y[2] - y[1]) / (x[2] - x[1]);
  if (!(left > 0.0) || !(right < 0.0)) {
    return x[1];
  }
  const double curvature = (right - left) / (x[2] - x[0]);
  return std::clamp(0.5 * (x[0] + x[1]) - 0.5 * left / curvature, x[0], x[2]);
}

}  // namespace

std::unique_ptr<Rival> make_hierarchical_equi_depth(const SensorModel& sensor,
                                                    const HierarchicalChoice& choice) {
  check_parts(choice.parts);
  return std::make_unique<Hierarchical>(sensor, choice.parts);
}

std::unique_ptr<Rival> make_proportional_equi_depth(const SensorModel& sensor,
                                                    const ProportionalChoice& choice) {
  check_parts(choice.parts);
  return std::make_unique<Proportional>(sensor, choice);
}

Measurement densest_place(std::vector<double> boundaries, int code_count) {
  constexpr double kHalfCode = 0.5;  // a boundary lies before its code, a position in the middle of it
  constexpr std::size_t kMostPartsWithoutParabola = 4;
  std::ranges::sort(boundaries);
  if (boundaries.size() == 1) {
    const double share = boundaries.front() / code_count;
    return {std::clamp(boundaries.front() - kHalfCode, 0.0, code_count - 1.0), std::abs(2.0 * share - 1.0)};
  }
  boundaries.insert(boundaries.begin(), 0.0);
  boundaries.push_back(code_count);
  const std::size_t parts = boundaries.size() - 1;
  const auto width = [&](std::size_t part) { return std::max(boundaries[part + 1] - boundaries[part], 0.5); };
  const auto centre = [&](std::size_t part) { return 0.5 * (boundaries[part + 1] + boundaries[part]); };
  std::size_t best = 0;
  for (std::size_t part = 1; part < parts; ++part) {
    best = width(part) < width(best) ? part : best;
  }
  double place = centre(best);
  if (parts > kMostPartsWithoutParabola && best > 0 && best + 1 < parts && centre(best - 1) < place &&
      place < centre(best + 1)) {
    place = parabola_top({centre(best - 1), place, centre(best + 1)},
                         {1.0 / width(best - 1), 1.0 / width(best), 1.0 / width(best + 1)});
  }
  const double mean_width = static_cast<double>(code_count) / static_cast<double>(parts);
  return {std::clamp(place - kHalfCode, 0.0, code_count - 1.0),
          std::max(mean_width / width(best) - 1.0, 0.0)};
}

}  // namespace dtof
