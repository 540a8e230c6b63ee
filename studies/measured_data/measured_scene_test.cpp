// SPDX-License-Identifier: Apache-2.0
#include "measured_data/measured_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "dtof/core/error.hpp"

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

TEST(TwoSurfacesScene, RefusesSurfacesOfAnotherSize) {
  TwoSurfaces recording = two_surfaces();
  recording.second = {2, 1, {2000, 2000}};
  EXPECT_THAT([&] { (void)two_surfaces_scene(recording); },
              ThrowsMessage<InputError>(HasSubstr("3 x 1 and 2 x 1 pixels, photon times of 3 x 1")));
}

}  // namespace
}  // namespace dtof
