// SPDX-License-Identifier: Apache-2.0
#include "dtof/rival/equi_depth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/core/random.hpp"
#include "tests/rival/test_pixels.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

SensorModel small(int np, std::uint32_t acquisitions) {
  SensorModel sensor;
  sensor.np = np;
  sensor.acquisitions = acquisitions;
  return sensor;
}

/// Detections of these acquisitions, several in one.
std::vector<Detection> at(std::initializer_list<std::pair<std::uint32_t, int>> events) {
  std::vector<Detection> detections;
  for (const auto& [acquisition, timestamp] : events) {
    detections.push_back({acquisition, static_cast<Timestamp>(timestamp)});
  }
  return detections;
}

TEST(OneBinner, MovesBySignOfLateLessEarly) {
  const std::unique_ptr<Rival> median = make_hierarchical_equi_depth(small(4, 10), {.parts = 2});
  EXPECT_EQ(median->bits_per_pixel(), 4);
  EXPECT_THAT(read_one_frame(*median, {}), ElementsAre(8));
  EXPECT_THAT(read_one_frame(*median, at({{0, 8}})), ElementsAre(9)) << "its own code is late";
  EXPECT_THAT(read_one_frame(*median, at({{0, 7}})), ElementsAre(7));
  EXPECT_THAT(read_one_frame(*median, at({{0, 2}, {0, 14}})), ElementsAre(8)) << "one each in a cycle";
  EXPECT_THAT(read_one_frame(*median, at({{0, 9}, {0, 14}})), ElementsAre(9)) << "two of a kind are one step";
  EXPECT_THAT(read_one_frame(*median, at({{0, 15}, {1, 15}})), ElementsAre(8)) << "no detection";
}

// Its closed form: the boundary ends where half of the detections are on either side.
TEST(OneBinner, IsTheMedian) {
  const SensorModel sensor = small(10, 40000);
  const std::unique_ptr<Rival> median = make_hierarchical_equi_depth(sensor, {.parts = 2});
  CounterRandom random(3, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  std::vector<int> timestamps;
  for (int i = 0; i < 40000; ++i) {
    const double u = random.uniform();
    timestamps.push_back(static_cast<int>(1023.0 * u * u));  // median 1023 / 4
  }
  EXPECT_NEAR(read_one_frame(*median, one_each(timestamps))[0], 1023.0 / 4.0, 25.0);
}

// Four parts: the first half of the frame moves the middle, the second half the quarters between their
// parents.
TEST(Hierarchical, LevelsFollowEachOther) {
  const std::unique_ptr<Rival> four = make_hierarchical_equi_depth(small(4, 4), {.parts = 4});
  EXPECT_EQ(four->bits_per_pixel(), 3 * 4);
  EXPECT_THAT(read_one_frame(*four, {}), ElementsAre(4, 8, 12));
  EXPECT_THAT(read_one_frame(*four, at({{0, 14}, {1, 14}})), ElementsAre(5, 10, 13));
  // In the second level 14 is beyond the middle: the left boundary does not count it.
  EXPECT_THAT(read_one_frame(*four, at({{0, 14}, {1, 14}, {2, 14}, {3, 1}})), ElementsAre(4, 10, 14));
}

// The middle goes to 7, where 6 is early, and back, ten times; then the right boundary stands at 7 between 6
// and 8.
TEST(Hierarchical, AMoveOntoAParentIsDropped) {
  const std::unique_ptr<Rival> four = make_hierarchical_equi_depth(small(3, 20), {.parts = 4});
  std::vector<int> timestamps(11, 6);
  EXPECT_THAT(read_one_frame(*four, one_each(timestamps)), ElementsAre(3, 6, 7));
  timestamps.back() = 0;
  EXPECT_THAT(read_one_frame(*four, one_each(timestamps)), ElementsAre(2, 6, 7));
}

TEST(Proportional, MovesByTheQuantile) {
  const std::unique_ptr<Rival> four = make_proportional_equi_depth(small(4, 10), {.parts = 4});
  EXPECT_EQ(four->bits_per_pixel(), 3 * (4 + 6));
  // e starts at 4, 8, 12 codes, 64 steps a code. One late detection: d = q; one early: d = -(1 - q).
  EXPECT_THAT(read_one_frame(*four, at({{0, 14}})), ElementsAre(256 + 16, 512 + 32, 768 + 48));
  EXPECT_THAT(read_one_frame(*four, at({{0, 1}})), ElementsAre(256 - 48, 512 - 32, 768 - 16));
  EXPECT_THAT(read_one_frame(*four, at({{0, 1}, {0, 14}})), ElementsAre(256 - 16, 512, 768 + 16));
}

// What has gathered speed would run on beyond the last code.
TEST(Proportional, StaysInTheRange) {
  const SensorModel sensor = small(10, 3000);
  for (const bool optimised : {false, true}) {
    const std::unique_ptr<Rival> two =
        make_proportional_equi_depth(sensor, {.parts = 2, .optimised = optimised});
    const int fraction = optimised ? 8 : 6;
    for (const std::size_t count : {40U, 50U, 60U, 80U, 3000U}) {
      EXPECT_LT(read_one_frame(*two, one_each(std::vector<int>(count, 1022)))[0], 1024 << fraction) << count;
      EXPECT_GE(read_one_frame(*two, one_each(std::vector<int>(count, 0)))[0], 0) << count;
    }
  }
}

/// The paper's equations in floating point.
std::vector<double> optimised_reference(const std::vector<int>& timestamps, int parts, double codes) {
  std::vector<double> boundaries;
  const auto cycles = static_cast<double>(timestamps.size());
  for (int i = 1; i < parts; ++i) {
    const double q = static_cast<double>(i) / parts;
    double e = q * codes;
    double m = 0.0;
    double s = 0.0;
    for (std::size_t c = 0; c < timestamps.size(); ++c) {
      const double d = timestamps[c] < e ? -(1.0 - q) : q;
      const double fall = std::max(0.02, std::pow(0.02, static_cast<double>(c) / (0.8 * cycles)));
      m = 0.95 * m + 0.05 * d;
      s = (0.2 * (3.0 * codes / 100.0) * m + 0.8 * s) * fall;
      e = std::clamp(e + s, 0.0, codes);
    }
    boundaries.push_back(e);
  }
  return boundaries;
}

/// A pulse at 300 of 1023 codes in a flat background as strong.
std::vector<int> pulse_on_background(int count) {
  CounterRandom random(5, static_cast<std::uint32_t>(RandomPurpose::kTestStream), 0, 0);
  std::vector<int> timestamps;
  for (int i = 0; i < count; ++i) {
    const double flat = 1023.0 * random.uniform();
    const double pulse = 300.0 + 40.0 * (random.uniform() + random.uniform() - 1.0);
    timestamps.push_back(static_cast<int>(i % 2 == 0 ? flat : pulse));
  }
  return timestamps;
}

TEST(Proportional, OptimisedEqualsThePapersEquations) {
  const std::vector<int> timestamps = pulse_on_background(3000);
  const std::unique_ptr<Rival> eight =
      make_proportional_equi_depth(small(10, 3000), {.parts = 8, .optimised = true});
  EXPECT_EQ(eight->bits_per_pixel(), 7 * 42);
  const RivalWords words = read_one_frame(*eight, one_each(timestamps));
  const std::vector<double> expected = optimised_reference(timestamps, 8, 1024.0);
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_NEAR(words[i] / 256.0, expected[i], 10.0) << i;
  }
}

// Sadekar et al.: the optimised steps bring boundaries to their quantiles in fewer cycles than the plain
// ones.
TEST(Proportional, OptimisedComesCloserToTheQuantiles) {
  const std::vector<int> timestamps = pulse_on_background(1000);
  std::vector<int> sorted = timestamps;
  std::ranges::sort(sorted);
  const auto error = [&](bool optimised) {
    const std::unique_ptr<Rival> eight =
        make_proportional_equi_depth(small(10, 1000), {.parts = 8, .optimised = optimised});
    const RivalWords words = read_one_frame(*eight, one_each(timestamps));
    double sum = 0.0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const double quantile = sorted[(i + 1) * sorted.size() / 8];
      sum += std::abs(std::ldexp(words[i], optimised ? -8 : -6) - quantile);
    }
    return sum / static_cast<double>(words.size());
  };
  EXPECT_LT(error(true), 0.5 * error(false));
}

TEST(DensestPlace, CentreOfTheNarrowestPart) {
  EXPECT_DOUBLE_EQ(densest_place({100.0, 300.0, 340.0}, 1024).position, 319.5);
  EXPECT_DOUBLE_EQ(densest_place({340.0, 100.0, 300.0}, 1024).position, 319.5)
      << "boundaries may have crossed";
  EXPECT_DOUBLE_EQ(densest_place({300.0}, 1024).position, 299.5) << "one boundary is the result";
  EXPECT_DOUBLE_EQ(densest_place({100.0, 300.0, 340.0}, 1024).confidence, 256.0 / 40.0 - 1.0);
  EXPECT_DOUBLE_EQ(densest_place({256.0, 512.0, 768.0}, 1024).confidence, 0.0);
}

// With more parts the density between centres is a parabola: on even flanks its top is the centre, else it
// leans.
TEST(DensestPlace, LeansToTheNarrowerNeighbour) {
  const std::vector<double> even = {128.0, 384.0, 424.0, 454.0, 494.0, 640.0, 832.0};
  EXPECT_DOUBLE_EQ(densest_place(even, 1024).position, 438.5);
  const std::vector<double> leaning = {128.0, 384.0, 424.0, 454.0, 524.0, 640.0, 832.0};
  EXPECT_LT(densest_place(leaning, 1024).position, 438.5);
  EXPECT_GT(densest_place(leaning, 1024).position, 403.5);
}

// Without noise and with much light every kind finds the pulse; two parts would need their own table.
TEST(EquiDepth, FindsANoiseFreePulse) {
  const SensorModel sensor = small(10, 20000);
  std::vector<std::unique_ptr<Rival>> rivals;
  rivals.push_back(make_hierarchical_equi_depth(sensor, {.parts = 8}));
  rivals.push_back(make_proportional_equi_depth(sensor, {.parts = 8, .optimised = true}));
  rivals.push_back(make_proportional_equi_depth(sensor, {.parts = 16, .optimised = true}));
  for (const double centre : {300.0, 511.0, 700.0}) {
    const std::vector<Detection> pixel = noise_free_pulse(sensor, centre, 15000.0, 2);
    for (std::size_t i = 0; i < rivals.size(); ++i) {
      EXPECT_NEAR(rivals[i]->decode(read_one_frame(*rivals[i], pixel)).position, centre, 12.0) << i;
    }
  }
}

TEST(EquiDepth, RefusesOtherNumbersOfParts) {
  EXPECT_THAT([] { (void)make_hierarchical_equi_depth(small(10, 10), {.parts = 6}); },
              ThrowsMessage<InputError>(HasSubstr("equi-depth: 6 parts")));
  EXPECT_THAT([] { (void)make_proportional_equi_depth(small(10, 10), {.parts = 1}); },
              ThrowsMessage<InputError>(HasSubstr("equi-depth: 1 parts")));
}

}  // namespace
}  // namespace dtof
