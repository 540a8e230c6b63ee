// SPDX-License-Identifier: Apache-2.0
#include "measured_data/measured_scene.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "dtof/core/error.hpp"
#include "dtof/io/npy.hpp"

namespace dtof {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kMetresPerTick = 0.5 * 299792458.0 * 8e-12;

/// Two pixels, the near surface stronger in the first, the far one in the second; a third saw nothing.
TwoSurfaces two_surfaces() {
  TwoSurfaces recording;
  recording.photons = {3, 1, {1000, 1010, 990, 2000, 1005, 2010, 1990}, {0, 4, 7, 7}};
  recording.first = {3, 1, {1000, 1000, 1000}};
  recording.second = {3, 1, {2000, 2000, 2000}};
  return recording;
}

auto metres(double tick) { return DoubleNear(tick * kMetresPerTick, 1e-9); }

TEST(TwoSurfacesScene, TruthIsTheSurfaceOfMorePhotons) {
  const MeasuredScene scene = two_surfaces_scene(two_surfaces());
  EXPECT_EQ(scene.columns, 3);
  EXPECT_EQ(scene.rows, 1);
  EXPECT_THAT(scene.true_m, ElementsAre(metres(1000), metres(2000), 0.0));
  EXPECT_THAT(scene.other_m, ElementsAre(metres(2000), metres(1000), 0.0));
}

TEST(TwoSurfacesScene, LeavesEarlierPhotonsOut) {
  TwoSurfaces recording = two_surfaces();
  recording.from_tick = 1500;
  const MeasuredScene scene = two_surfaces_scene(recording);
  EXPECT_THAT(scene.true_m, ElementsAre(metres(2000), metres(2000), 0.0));
  EXPECT_TRUE(scene.other_m.empty());
  Resampling resampling;
  resampling.acquisitions = 100;
  const auto frame = scene.frame(resampling);
  EXPECT_EQ(frame->column(0).row(0).size(), 1U);
  EXPECT_EQ(frame->column(1).row(0).size(), 2U);
  EXPECT_EQ(frame->column(2).row(0).size(), 0U);
}

TEST(TwoSurfacesScene, ShiftsTimesAndDistancesAlike) {
  TwoSurfaces recording = two_surfaces();
  recording.shift_s = -4e-9;  // 500 ticks
  const MeasuredScene scene = two_surfaces_scene(recording);
  EXPECT_THAT(scene.true_m, ElementsAre(metres(500), metres(1500), 0.0));
  Resampling resampling;
  resampling.acquisitions = 100;
  const auto frame = scene.frame(resampling);
  const ColumnStream column = frame->column(1);
  // 2010 - 500 ticks of 8 ps in bins of 45 ns / 1024.
  EXPECT_EQ(std::ranges::max(column.row(0), {}, &Detection::timestamp).timestamp, 274);
}

/// Histograms of 1 ns: `counts` of each pixel of one row, as an NPY file.
MeasuredScene scene_of(const std::vector<std::vector<double>>& pixels, RecordedSceneOptions options = {}) {
  std::string file = npy_header("<f8", std::vector<std::size_t>{1, pixels.size(), pixels.front().size()});
  for (const std::vector<double>& counts : pixels) {
    for (const double count : counts) {
      std::array<char, sizeof count> bytes{};
      std::memcpy(bytes.data(), &count, sizeof count);
      file.append(bytes.data(), bytes.size());
    }
  }
  options.recording.file = "mine.npy";
  options.recording.bin_width_s = 1e-9;
  return recorded_scene(options, {.contents = file, .format = "npy"});
}

/// One photon in each of 40 bins, and a peak of two bins from `bin` on.
std::vector<double> peak_at(std::size_t bin, double photons) {
  std::vector<double> counts(40, 1.0);
  counts[bin] += photons;
  counts[bin + 1] += photons;
  return counts;
}

constexpr double kMetresPerNs = 0.5 * 299792458.0 * 1e-9;

TEST(RecordedScene, WithoutDistancesTheStrongestReturnIsTheTruth) {
  const std::vector<double> even(40, 1.0);
  const MeasuredScene scene = scene_of({peak_at(10, 30.0), even, peak_at(25, 20.0)});
  EXPECT_EQ(scene.columns, 3);
  EXPECT_EQ(scene.rows, 1);
  EXPECT_THAT(scene.true_m,
              ElementsAre(DoubleNear(11.0 * kMetresPerNs, 1e-9), 0.0, DoubleNear(26.0 * kMetresPerNs, 1e-9)));
  EXPECT_EQ(scene.title, "Recording: histogram cube");
  EXPECT_EQ(scene.contents.find("histogram cube"), 0U);
  EXPECT_EQ(scene.truth,
            (MeasuredTruth{.origin = TruthOrigin::kStrongestReturn, .window_s = 2e-9, .without_return = 1}));
  const MeasuredScene shifted = scene_of({peak_at(10, 30.0)}, {.recording = {}, .shift_s = 5e-9});
  EXPECT_THAT(shifted.true_m, ElementsAre(DoubleNear(16.0 * kMetresPerNs, 1e-9)));
  Resampling resampling;
  resampling.acquisitions = 65535;
  const auto frame = shifted.frame(resampling);
  EXPECT_EQ(frame->column(0).row(0).size(), 100U);
  // The first bin begins at 5 ns, in bins of 45 ns / 1024.
  EXPECT_GE(std::ranges::min(frame->column(0).row(0), {}, &Detection::timestamp).timestamp, 113);
}

TEST(RecordedScene, AnEarlierWindowEndsBeforeTheDistance) {
  // A photon's distance is that of light on its way there and back: a window may not begin before the shot.
  const MeasuredScene scene =
      scene_of({peak_at(2, 30.0), peak_at(20, 30.0)}, {.recording = {}, .shift_s = -10e-9});
  EXPECT_THAT(scene.true_m, ElementsAre(0.0, DoubleNear(11.0 * kMetresPerNs, 1e-9)));
}

TEST(RecordedScene, RefusesARecordingWithoutReturnsAndATdcStream) {
  const std::vector<double> even(40, 1.0);
  EXPECT_THAT(
      [&] {
        (void)scene_of({even, even});
      },
      ThrowsMessage<InputError>("mine.npy: none of its 2 pixels has a return: chance explains the number of "
                                "photons in the fullest 2 "
                                "ns of each (--return-window); --truth gives distances"));
  EXPECT_TRUE(scene_of({even}, {.recording = {}, .truth_is_given = true}).true_m.empty());
  EXPECT_THAT(
      [] {
        (void)recorded_scene({.recording = {.file = "mine.csv"}},
                             {.contents = "acquisition,column,row,timestamp\n0,0,0,5\n", .format = "csv"});
      },
      ThrowsMessage<InputError>(
          "mine.csv: a TDC stream is one frame as it was recorded, from which no others can be "
          "drawn; dtof replay reads it out"));
}

TEST(RecordedScene, PixelsBeyondTheRangeAreLeftOut) {
  MeasuredScene scene = scene_of({peak_at(10, 30.0), peak_at(35, 30.0)});
  scene.other_m = {2.5, 3.5};
  leave_out_beyond_range(scene, 30e-9, "mine.npy");
  EXPECT_THAT(scene.true_m, ElementsAre(DoubleNear(11.0 * kMetresPerNs, 1e-9), 0.0));
  EXPECT_NEAR(scene.truth.range_m, 30.0 * kMetresPerNs, 1e-9);
  EXPECT_EQ(scene.truth.beyond_range, 1U);
  EXPECT_EQ(truth_csv(scene), "column,row,true_m,other_m\n0,0,1.648859,2.500000\n1,0,,\n");
  EXPECT_THAT([&] { leave_out_beyond_range(scene, 10e-9, "mine.npy"); },
              ThrowsMessage<InputError>(
                  "mine.npy: every true distance is beyond the range, 1.50 m (light there and back "
                  "in 10 ns): --t-int changes it"));
  EXPECT_THAT([&] { leave_out_beyond_range(scene, 10e-9, "mine.npy"); },
              ThrowsMessage<InputError>("mine.npy: no pixel has a known distance"));
}

/// A capture of a TMF8820: 9 zones with this photon count in each bin.
std::string capture(const std::string& distance, int count) {
  std::string zones;
  for (int zone = 0; zone < 9; ++zone) {
    zones += zone == 0 ? "[" : ",[";
    for (int bin = 0; bin < 128; ++bin) {
      zones += fmt::format("{}{}", bin == 0 ? "" : ",", count);
    }
    zones += "]";
  }
  return fmt::format(R"({{"dist_to_plane": {}, "hists": [{}]}})", distance, zones);
}

TEST(RecordedScene, AWindowWithoutEffectIsRefused) {
  EXPECT_THAT(
      [] {
        (void)recorded_scene({.recording = {.file = "a.json"}, .return_window_s = 1e-9},
                             {.contents = "[" + capture("0.25", 3) + "]", .format = "tmf8820"});
      },
      ThrowsMessage<InputError>("--return-window has no effect: the recording has true distances"));
}

TEST(RecordedScene, DistancesOfTheRecordingAreTheTruthOfPixelsWithPhotons) {
  const MeasuredScene scene = recorded_scene(
      {.recording = {.file = "a.json"}},
      {.contents = fmt::format("[{}, {}, {}]", capture("0.25", 3), capture("null", 3), capture("0.5", 0)),
       .format = "tmf8820"});
  EXPECT_EQ(scene.columns, 3);
  EXPECT_EQ(scene.rows, 9);
  EXPECT_EQ(scene.title, "Recording: ams TMF8820");
  EXPECT_EQ(scene.truth.origin, TruthOrigin::kPlane);
  EXPECT_THAT(std::vector(scene.true_m.begin() + 24, scene.true_m.end()), ElementsAre(0.25, 0.0, 0.0));
}

TEST(TwoSurfacesScene, RefusesSurfacesOfAnotherSize) {
  TwoSurfaces recording = two_surfaces();
  recording.second = {2, 1, {2000, 2000}};
  EXPECT_THAT([&] { (void)two_surfaces_scene(recording); },
              ThrowsMessage<InputError>(HasSubstr("3 x 1 and 2 x 1 pixels, photon times of 3 x 1")));
}

}  // namespace
}  // namespace dtof
