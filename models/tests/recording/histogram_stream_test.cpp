// SPDX-License-Identifier: Apache-2.0
#include "dtof/recording/histogram_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "dtof/core/random.hpp"
#include "dtof/io/npy.hpp"
#include "tests/io/io_test_support.hpp"

namespace dtof {
namespace {

using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::EndsWith;
using ::testing::IsEmpty;

HistogramCube cube_of(int columns, int rows, const std::vector<double>& pixel) {
  HistogramCube cube{
      .columns = columns, .rows = rows, .bins = static_cast<int>(pixel.size()), .bin_width = 1e-9};
  for (int i = 0; i < columns * rows; ++i) {
    cube.counts.insert(cube.counts.end(), pixel.begin(), pixel.end());
  }
  return cube;
}

std::vector<double> code_counts(const StreamSource& source, int np) {
  std::vector<double> counts(std::size_t{1} << static_cast<unsigned>(np));
  for (int column = 0; column < source.columns(); ++column) {
    const ColumnStream stream = source.column(column);
    for (int row = 0; row < stream.rows(); ++row) {
      for (const Detection& detection : stream.row(row)) {
        counts.at(detection.timestamp) += 1.0;
      }
    }
  }
  return counts;
}

TEST(AssignToAcquisitions, QuantisesDropsOutsideAndKeepsTheFirstSlotsInTime) {
  const Resampling one{.np = 4, .integration_time = 16.0, .acquisitions = 1, .slots = 3};
  CounterRandom random(1, 1, 0, 0);
  const std::vector<double> times = {15.999, 3.0, 2.9999, -1e-9, 16.0, 0.0, 40.0};
  EXPECT_THAT(assign_to_acquisitions(times, one, random),
              ElementsAre(Detection{0, 0}, Detection{0, 2}, Detection{0, 3}));
  Resampling four = one;
  four.slots = 4;
  EXPECT_THAT(assign_to_acquisitions(times, four, random),
              ElementsAre(Detection{0, 0}, Detection{0, 2}, Detection{0, 3}, Detection{0, 15}));
  Resampling none = one;
  none.acquisitions = 0;
  EXPECT_THAT(assign_to_acquisitions(times, none, random), IsEmpty());
}

TEST(AssignToAcquisitions, NotANumberIsLost) {
  CounterRandom random(1, 1, 0, 0);
  EXPECT_THAT(
      assign_to_acquisitions(std::vector<double>{std::nan(""), std::numeric_limits<double>::infinity()},
                             {.acquisitions = 1}, random),
      IsEmpty());
}

TEST(HistogramStream, RowsAloneAreThoseOfTheColumn) {
  const HistogramStream stream(
      cube_of(3, 6, {0, 3, 0, 20, 7, 0, 0, 2}),
      {.np = 4, .integration_time = 8e-9, .acquisitions = 100, .photon_budget = 30.0});
  const ColumnStream whole = stream.column(1);
  const ColumnStream part = stream.column_rows(1, {.first = 2, .count = 3});
  ASSERT_EQ(part.rows(), 3);
  for (int row = 0; row < 3; ++row) {
    EXPECT_THAT(part.row(row), ElementsAreArray(whole.row(row + 2)));
    EXPECT_GT(part.row(row).size(), 0U);
  }
}

TEST(HistogramStream, WithoutBudgetEveryCountIsOnePhoton) {
  // 16 bins of 1 ns in a 16 ns window of 4 bits: bin k is code k. One photon an acquisition is rare to
  // collide.
  const std::vector<double> pixel = {0, 3, 0, 20, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2};
  const HistogramStream stream(cube_of(2, 3, pixel),
                               {.np = 4, .integration_time = 16e-9, .acquisitions = 5000, .slots = 32});
  std::vector<double> expected = pixel;
  for (double& count : expected) {
    count *= 6;
  }
  EXPECT_EQ(code_counts(stream, 4), expected);
  EXPECT_EQ(stream.rows(), 3);
  EXPECT_EQ(stream.acquisitions(), 5000U);
}

TEST(HistogramStream, IsAPureFunctionOfSeedFrameAndPixel) {
  const std::uint64_t seed = test::test_seed();
  SCOPED_TRACE(fmt::format("DTOF_TEST_SEED={}", seed));
  const HistogramCube cube = cube_of(3, 2, {5, 1, 8, 2});
  Resampling resampling{.integration_time = 4e-9, .photon_budget = 200.0, .background = 0.02, .seed = seed};
  const HistogramStream stream(cube, resampling);
  EXPECT_EQ(stream.column(1), stream.column(1));
  EXPECT_NE(stream.column(0), stream.column(1));
  resampling.frame = 1;
  EXPECT_NE(HistogramStream(cube, resampling).column(1), stream.column(1));
  resampling.frame = 0;
  resampling.seed += 1;
  EXPECT_NE(HistogramStream(cube, resampling).column(1), stream.column(1));
}

TEST(HistogramStream, RowsAreSortedAndHaveAtMostTheSlots) {
  const HistogramStream stream(
      cube_of(1, 8, {5, 1, 8, 2}),
      {.integration_time = 4e-9, .acquisitions = 50, .slots = 2, .photon_budget = 200.0});
  const ColumnStream column = stream.column(0);
  bool pile_up = false;
  for (int row = 0; row < column.rows(); ++row) {
    const auto detections = column.row(row);
    EXPECT_LE(detections.size(), 100U);
    for (std::size_t i = 1; i < detections.size(); ++i) {
      const bool same = detections[i].acquisition == detections[i - 1].acquisition;
      EXPECT_GE(detections[i].acquisition, detections[i - 1].acquisition);
      EXPECT_TRUE(!same || detections[i].timestamp >= detections[i - 1].timestamp);
      pile_up |= same;
      EXPECT_FALSE(i >= 2 && detections[i].acquisition == detections[i - 2].acquisition);
    }
  }
  EXPECT_TRUE(pile_up);
}

TEST(HistogramStream, ThinningKeepsTheShape) {
  const std::uint64_t seed = test::test_seed();
  SCOPED_TRACE(fmt::format("DTOF_TEST_SEED={}", seed));
  const std::vector<double> pixel = {1e6, 0, 3e6, 5e5, 2.5e6, 0, 1e6, 2e6};
  const HistogramStream stream(cube_of(10, 10, pixel), {.np = 3,
                                                        .integration_time = 8e-9,
                                                        .acquisitions = 100000,
                                                        .slots = 4,
                                                        .photon_budget = 1000.0,
                                                        .seed = seed});
  const std::vector<double> counts = code_counts(stream, 3);
  const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
  // 1e5 photons, Poisson: sd 316; beyond five sigma once in 1.7 million seeds.
  EXPECT_NEAR(sum, 1e5, 5 * 316.3);
  double chi_square = 0.0;
  for (std::size_t i = 0; i < pixel.size(); ++i) {
    const double expected = sum * pixel[i] / 1e7;
    if (expected == 0.0) {
      EXPECT_EQ(counts[i], 0.0);
    } else {
      chi_square += (counts[i] - expected) * (counts[i] - expected) / expected;
    }
  }
  // 5 degrees of freedom: above 33.1 with probability 3.6e-6.
  EXPECT_LT(chi_square, 33.1);
}

TEST(HistogramStream, FixedNumberAndJitterInsideABin) {
  const HistogramStream stream(cube_of(1, 1, {0, 10, 0, 0}), {.np = 8,
                                                              .integration_time = 4e-9,
                                                              .acquisitions = 1000000,
                                                              .slots = 8,
                                                              .photon_budget = 64000.0,
                                                              .photon_number = PhotonNumber::kFixed,
                                                              .seed = test::test_seed()});
  const std::vector<double> counts = code_counts(stream, 8);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0.0), 64000.0);
  EXPECT_EQ(std::accumulate(counts.begin() + 64, counts.begin() + 128, 0.0), 64000.0);
  for (std::size_t code = 64; code < 128; ++code) {
    EXPECT_NEAR(counts[code], 1000.0, 6 * 31.7) << code;  // 2e-9 a code
  }
}

TEST(HistogramStream, ShiftOffsetAndBackground) {
  HistogramCube cube = cube_of(1, 1, {50});
  cube.offset = 3e-9;
  const Resampling shifted{
      .np = 4, .integration_time = 16e-9, .time_shift = 2e-9, .acquisitions = 1000, .slots = 8};
  EXPECT_EQ(code_counts(HistogramStream(cube, shifted), 4)[5], 50.0);
  Resampling beyond = shifted;
  beyond.time_shift = -5e-9;
  EXPECT_EQ(HistogramStream(cube, beyond).column(0).detection_count(), 0U);

  Resampling bright = shifted;
  bright.acquisitions = 100000;
  bright.background = 0.16;
  bright.slots = 64;
  const std::vector<double> counts = code_counts(HistogramStream(cube, bright), 4);
  for (std::size_t code = 0; code < counts.size(); ++code) {
    EXPECT_NEAR(counts[code] - (code == 5 ? 50.0 : 0.0), 1000.0, 6 * 31.7) << code;
  }
}

TEST(HistogramStream, EmptyPixelsAndNoAcquisitions) {
  const HistogramCube dark = cube_of(1, 2, {0, 0, 0});
  EXPECT_EQ(HistogramStream(dark, {.photon_budget = 100.0}).column(0), HistogramStream(dark, {}).column(0));
  EXPECT_EQ(HistogramStream(dark, {.photon_budget = 100.0}).column(0).rows(), 2);
  EXPECT_EQ(HistogramStream(cube_of(1, 1, {9}), {.acquisitions = 0}).column(0).detection_count(), 0U);
}

TEST(HistogramStream, Refusals) {
  const HistogramCube cube = cube_of(1, 1, {1.5, 2});
  test::expect_input_error(
      [&] { HistogramStream(cube, {}); },
      "histograms: column 0, row 0, bin 0: count 1.5 is not an integer; give a photon budget (--photons)");
  HistogramCube named = cube_of(2, 1, {1, 2, 3, 0.5});
  named.name = "a.npy";
  test::expect_input_error(
      [&] { HistogramStream(named, {}); },
      "a.npy: column 0, row 0, bin 3: count 0.5 is not an integer; give a photon budget (--photons)");
  const auto refused = [&](const Resampling& resampling, const std::string& reason) {
    test::expect_input_error([&] { HistogramStream(cube, resampling); }, "resampling: " + reason);
  };
  refused({.photon_budget = -1.0}, "photon budget is -1, must be 0..1e7 photons per pixel");
  refused({.photon_budget = std::nan("")}, "photon budget is nan, must be 0..1e7 photons per pixel");
  refused({.np = 0}, "NP is 0, must be 1..16");
  refused({.integration_time = 0.0}, "integration time is 0, must be a positive number of seconds");
  refused({.time_shift = std::nan("")}, "time shift is nan, must be a finite number of seconds");
  refused({.slots = 0}, "SLOTS is 0, must be 1 or more");
  refused({.background = -0.1},
          "background is -0.1, must be 0 or more events per acquisition, at most 1e7 per frame");
  Resampling bright{.acquisitions = 5000, .background = 2e3};  // 1e7 photons
  bright.validate();
  bright.acquisitions = 5001;
  refused(bright, "background is 2000, must be 0 or more events per acquisition, at most 1e7 per frame");
  const HistogramCube many = cube_of(2, 1, {0, 0, 4294967296.0, 1});
  test::expect_input_error([&] { HistogramStream(many, {}); },
                           "histograms: column 0, row 0: 4294967297 photons are more than the 1e+07 that a "
                           "pixel can have in a frame; give a photon budget (--photons)");
  EXPECT_GT(HistogramStream(many, {.photon_budget = 100.0}).column(1).detection_count(), 0U);
  HistogramCube bad = cube;
  bad.true_distance = {1.0, 2.0};
  test::expect_input_error([&] { HistogramStream(bad, {.photon_budget = 1.0}); },
                           EndsWith("2 true distances for 1 pixels"));
}

TEST(HistogramCube, FromArrays) {
  NpyArray array{.shape = {2, 3, 4}, .values = std::vector<double>(24)};
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    array.values[i] = static_cast<double>(i);
  }
  const HistogramCube cube = histogram_cube(array, 1e-9);
  EXPECT_EQ(cube.rows, 2);
  EXPECT_EQ(cube.columns, 3);
  EXPECT_THAT(cube.pixel(2, 1), ElementsAre(20, 21, 22, 23));
  EXPECT_EQ(histogram_cube({.shape = {24}, .values = array.values}, 1e-9).bins, 24);
  EXPECT_EQ(histogram_cube({.shape = {6, 4}, .values = array.values}, 1e-9).columns, 6);
  EXPECT_EQ(histogram_cube({.shape = {2, 3, 2, 2}, .values = array.values}, 1e-9).rows, 6);
  array.values[21] = -1;
  test::expect_input_error([&] { (void)histogram_cube(array, 1e-9); },
                           "histograms: column 2, row 1, bin 1: count -1 is not in 0..2^53");
  array.values[21] = std::numeric_limits<double>::quiet_NaN();
  test::expect_input_error([&] { (void)histogram_cube(array, 1e-9); },
                           EndsWith("count nan is not in 0..2^53"));
  array.values[21] = 0;
  test::expect_input_error([&] { (void)histogram_cube(array, 0.0); },
                           "histograms: bin width is 0, must be a positive number of seconds");
  test::expect_input_error([&] { (void)histogram_cube(array, 0.0, 0.0, "a.npy"); },
                           "a.npy: bin width is 0, must be a positive number of seconds");
  test::expect_input_error([&] { (void)histogram_cube({.shape = {}, .values = {1}}, 1e-9); },
                           "histograms: the array is a single number, its last axis must be the bins");
}

}  // namespace
}  // namespace dtof
