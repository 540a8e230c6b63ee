// SPDX-License-Identifier: Apache-2.0
// Amplitude and ambient of poolPointer against closed forms (docs/reference/poolpointer.md, Amplitude and
// ambient) on a flat target: events of a pixel are a Poisson process, of which the TDC keeps the first two.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "dtof/readout/pool_pointer.hpp"
#include "tests/core/test_seed.hpp"
#include "tests/readout/test_streams.hpp"

namespace dtof {
namespace {

constexpr int kNp = 10;
constexpr double kCells = 128.0;  // of the range
constexpr double kSigma = 2.4;    // of the pulse, cells
/// Part of the pulse within five cells of its middle, times the part of the acquisitions that are not thinned
/// at the target's place, 30 of 32.
constexpr double kInWindow = 0.963 * 30.0 / 32.0;
constexpr int kColumns = 6;
constexpr int kRows = 16;

/// Light on a pixel. Events per acquisition, and the target's place in cells.
struct Light {
  double signal;
  double background;
  double target = 80.0;

  /// Mean number of events before a place.
  [[nodiscard]] double before(double cell) const {
    const double part = std::erfc((target - cell) / (kSigma * std::numbers::sqrt2)) / 2.0;
    return background * std::clamp(cell / kCells, 0.0, 1.0) + signal * part;
  }
  [[nodiscard]] double all() const { return signal + background; }
  [[nodiscard]] double between(double begin, double end) const { return before(end) - before(begin); }
  /// Probability that the first event is in an interval.
  [[nodiscard]] double first(double begin, double end) const {
    return std::exp(-before(begin)) - std::exp(-before(end));
  }
  /// Probability that the second event is in an interval.
  [[nodiscard]] double second(double begin, double end) const {
    const auto fewer_than_two = [&](double cell) { return (1.0 + before(cell)) * std::exp(-before(cell)); };
    return fewer_than_two(begin) - fewer_than_two(end);
  }
};

double normal(CounterRandom& random) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) *
         std::cos(2.0 * std::numbers::pi * random.uniform());
}

int poisson(double mean, CounterRandom& random) {
  int count = 0;
  for (double product = random.uniform(); product > std::exp(-mean); product *= random.uniform()) {
    ++count;
  }
  return count;
}

std::vector<ColumnStream> flat_target(const Light& light, int acquisitions, CounterRandom& random) {
  std::vector<ColumnStream> array(kColumns);
  for (ColumnStream& column : array) {
    for (int row = 0; row < kRows; ++row) {
      std::vector<Detection> pixel;
      for (int a = 0; a < acquisitions; ++a) {
        std::vector<int> times;
        for (int i = poisson(light.background, random); i > 0; --i) {
          times.push_back(static_cast<int>(random.uniform() * (1 << kNp)));
        }
        for (int i = poisson(light.signal, random); i > 0; --i) {
          times.push_back(static_cast<int>((light.target + kSigma * normal(random)) / kCells * (1 << kNp)));
        }
        std::ranges::sort(times);
        for (std::size_t slot = 0; slot < std::min<std::size_t>(times.size(), 2); ++slot) {
          pixel.push_back({static_cast<std::uint32_t>(a), static_cast<Timestamp>(times[slot])});
        }
      }
      column.append_row(pixel);
    }
  }
  return array;
}

struct Means {
  double amplitude = 0.0;
  double ambient = 0.0;
};

Means measured(const std::vector<ColumnStream>& array, int acquisitions, Readout readout, int coarse_share,
               int track_share) {
  PoolNumbers numbers = pool_pointer_parameters(ReadoutParameters::defaults(readout));
  numbers.coarse_share = coarse_share;
  numbers.track_share = track_share;
  numbers.amplitude = true;
  std::vector<ColumnStream> frame(array.size());
  for (std::size_t column = 0; column < array.size(); ++column) {
    for (int row = 0; row < array[column].rows(); ++row) {
      std::vector<Detection> pixel;
      for (const Detection& detection : array[column].row(row)) {
        if (detection.acquisition < static_cast<std::uint32_t>(acquisitions)) {
          pixel.push_back(detection);
        }
      }
      frame[column].append_row(pixel);
    }
  }
  Means sums;
  for (const auto& column : run_pool_pointer(static_cast<int>(frame.size()), reader_of(std::span(frame)), kNp,
                                             static_cast<std::uint32_t>(acquisitions), numbers)) {
    for (const PixelResult& result : column) {
      sums.amplitude += result.amplitude;
      sums.ambient += result.ambient;
    }
  }
  return {sums.amplitude / (kColumns * kRows), sums.ambient / (kColumns * kRows)};
}

/// Counts that an acquisition adds to the amplitude: the timestamp that the pixel uses is in the leader's
/// window, or in that of the rival, which is somewhere in the background. Even and odd acquisitions.
std::array<double, 2> counts_of_an_acquisition(const Light& light) {
  const double hit_begin = light.target - 5.0;
  const double hit_end = light.target + 5.0;
  const double begin = light.target - 8.0;  // of the places where the other timestamp is used instead
  const double end = light.target + 8.0;
  const auto kept = [](double cell) { return 1.0 - std::max(7.0 - std::floor(cell / 16.0), 0.0) / 32.0; };
  const double hit_even = light.first(hit_begin, hit_end) * (1.0 + light.before(begin));
  const double hit_odd =
      light.second(hit_begin, hit_end) + light.between(hit_begin, hit_end) * std::exp(-light.before(end));
  double even = 0.0;
  double odd = 0.0;
  int places = 0;
  for (double rival = 8.0; rival <= 120.0; rival += 1.0) {
    const double from = rival - 6.0;
    const double to = rival + 6.0;
    if (from < end && to > begin) {
      continue;
    }
    const double single = light.between(from, to) * std::exp(-light.all());
    const double both_even = to <= begin ? light.between(from, to) *
                                               (std::exp(-light.before(begin)) - std::exp(-light.before(end)))
                                         : 0.0;
    const double both_odd = from >= end ? light.between(begin, end) * light.first(from, to) : 0.0;
    even += kept(rival) * (light.first(from, to) - both_even);
    odd += kept(rival) * (light.second(from, to) - both_odd + single);
    ++places;
  }
  return {kept(light.target) * hit_even - even / places, kept(light.target) * hit_odd - odd / places};
}

// From 64 counts on only every fourth or sixteenth acquisition counts, all of them even.
double expected_amplitude(const Light& light, double start, int acquisitions) {
  const std::array<double, 2> counts = counts_of_an_acquisition(light);
  const double mean = (counts[0] + counts[1]) / 2.0;
  const double slow = std::min(std::max(64.0 - start, 0.0) / mean, static_cast<double>(acquisitions));
  return std::min(start + mean * slow + counts[0] * (acquisitions - slow), 688.0);
}

class PoolAmplitude : public testing::Test {
 protected:
  static CounterRandom random(std::uint32_t which) {
    return {test_seed(), static_cast<std::uint32_t>(RandomPurpose::kTestStream), which, 7};
  }
  testing::ScopedTrace trace_{__FILE__, __LINE__, test_seed_message()};
};

TEST_F(PoolAmplitude, CountsTheTargetsLight) {
  std::uint32_t which = 0;
  for (const Light& light : {Light{0.02, 0.0}, Light{0.06, 0.02}, Light{0.03, 0.1}, Light{0.06, 0.3},
                             Light{0.1, 0.6}, Light{0.12, 1.0}, Light{0.06, 0.3, 24.0}}) {
    CounterRandom draw = random(which++);
    constexpr int kAcquisitions = 4800;
    const auto array = flat_target(light, kAcquisitions, draw);
    // Coarse and track phase have 1,200 acquisitions, the pointer phase 3,600, or 19 in the short frame.
    const double start = measured(array, 1219, Readout::kPoolPointer, 31, 32).amplitude;
    const double amplitude = measured(array, kAcquisitions, Readout::kPoolPointer, 8, 8).amplitude;
    const double expected = expected_amplitude(light, start, kAcquisitions - 1200 - 19);
    EXPECT_NEAR(amplitude, expected, 6.0 + 0.06 * expected)
        << "signal " << light.signal << ", background " << light.background << ", start " << start;
    EXPECT_LE(start, 63.0 + 19.0);
    if (light.background == 0.0) {
      EXPECT_NEAR(amplitude - start, kInWindow * light.signal * (kAcquisitions - 1219), 4.0)
          << "signal alone";
    }
  }
  CounterRandom draw = random(which);
  const auto bright = flat_target({0.6, 0.0}, 4000, draw);
  EXPECT_NEAR(measured(bright, 4000, Readout::kPoolPointer, 8, 8).amplitude, 688.0, 2.0) << "the largest";
  EXPECT_NEAR(measured(bright, 4000, Readout::kPoolPointerLean, 8, 8).amplitude, 72.0, 1.0);
}

TEST_F(PoolAmplitude, OfLeanCountsWeakLight) {
  std::uint32_t which = 20;
  for (const Light& light : {Light{0.01, 0.0}, Light{0.02, 0.05}, Light{0.03, 0.1}}) {
    CounterRandom draw = random(which++);
    constexpr int kAcquisitions = 1600;
    const auto array = flat_target(light, kAcquisitions, draw);
    const double start = measured(array, 609, Readout::kPoolPointerLean, 31, 32).amplitude;
    const double amplitude = measured(array, kAcquisitions, Readout::kPoolPointerLean, 12, 12).amplitude;
    // Ten cells of the leader's window, eight of the rival's.
    const double expected =
        start + (kInWindow * light.signal + light.background * 2.0 / kCells) * (kAcquisitions - 609);
    EXPECT_NEAR(amplitude, expected, 2.0 + 0.1 * expected)
        << "signal " << light.signal << ", background " << light.background << ", start " << start;
  }
}

// Half of the acquisitions count the first event, half the second if there are two; a pixel without an event
// leaves its turn to the other pixel.
TEST_F(PoolAmplitude, AmbientIsProportionalToTheBackgroundUntilABinIsFull) {
  std::uint32_t which = 40;
  for (const double background : {0.05, 0.2, 0.5, 1.0}) {
    CounterRandom draw = random(which++);
    const Light light{0.02, background};
    constexpr int kAcquisitions = 2560;
    constexpr int kCoarse = 400;
    const auto array = flat_target(light, kAcquisitions, draw);
    const double turns = 4.0 * (kCoarse - kCoarse / 64) * (1.0 + std::exp(-light.all())) / 2.0;
    double least = 1e9;
    for (double octet = 0.0; octet < kCells; octet += 32.0) {
      const double counts = turns * (light.first(octet, octet + 32.0) + light.second(octet, octet + 32.0) +
                                     light.between(octet, octet + 32.0) * std::exp(-light.all()));
      least = std::min(least, counts);
    }
    const double expected = 5.0 * (least - 0.5 * std::sqrt(least)) / 128.0;  // the smallest of few
    const double ambient = measured(array, kAcquisitions, Readout::kPoolPointer, 10, 20).ambient;
    EXPECT_NEAR(ambient, expected - 0.5, 0.4 + 0.05 * expected) << background << ": rounded down";
    // Lean's groups have twice as many pixels, and of B they keep multiples of four.
    const double lean = measured(array, kAcquisitions, Readout::kPoolPointerLean, 10, 20).ambient;
    EXPECT_NEAR(lean, 2.0 * expected, 1.5 + 0.1 * expected) << background;
  }
}

// Bins become full, and the background of five times the light hides more of itself behind early events.
TEST_F(PoolAmplitude, AmbientOfALongFrameIsNoMeasureOfTheLight) {
  CounterRandom draw = random(60);
  constexpr int kAcquisitions = 8000;
  const auto ambient = [&](double background) {
    const auto sky = flat_target({0.0, background}, kAcquisitions, draw);
    return measured(sky, kAcquisitions, Readout::kPoolPointer, 40, 10).ambient;
  };
  const double weak = ambient(0.2);
  const double strong = ambient(1.0);
  EXPECT_LT(strong, weak);
  EXPECT_GT(strong, 10.0);
  EXPECT_LT(weak, 30.0);
}

}  // namespace
}  // namespace dtof
