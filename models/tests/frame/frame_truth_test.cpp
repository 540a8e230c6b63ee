// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/frame_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::Not;

std::string refusal(const TargetMap& targets, bool millimetres = true) {
  try {
    require_reachable(targets, SensorModel(), "a.npy", millimetres);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(FrameTruth, IsThatOfTheRegionAndUnknownWithoutATarget) {
  TargetMap targets(3, 2);
  for (int column = 0; column < 3; ++column) {
    targets.at(column, 1) = {.depth_m = 1.0 + column, .reflectivity = 0.5};
  }
  const std::array<int, 2> columns = {0, 2};
  const FrameTruth known = frame_truth(targets, SensorModel(), columns, {.first = 1, .count = 1});
  EXPECT_THAT(known.metres, ElementsAre(1.0F, 3.0F));
  EXPECT_TRUE(known.any_judged());
  EXPECT_EQ(known.sentences(SensorModel()), "");
  const FrameTruth unknown = frame_truth(targets, SensorModel(), columns, {.first = 0, .count = 1});
  EXPECT_THAT(unknown.metres, ElementsAre(IsNan(), IsNan()));
  EXPECT_FALSE(unknown.any_judged());
  EXPECT_EQ(unknown.sentences(SensorModel()), " 2 pixels are without a true distance and not judged.");
}

TEST(FrameTruth, WhatTheSensorCannotSeeIsCountedApart) {
  // Light is there and back in 45 ns from 6.745 m.
  SensorModel sensor;
  EXPECT_NEAR(sensor_range_m(sensor), 6.7453, 1e-4);
  sensor.defects.dead = {{0, 0}, {2, 0}};
  TargetMap targets(4, 1, {.depth_m = 6.7, .reflectivity = 1.0});
  targets.at(1, 0).depth_m = 6.75;
  targets.at(2, 0).depth_m = 6.75;
  const std::array<int, 4> columns = {0, 1, 2, 3};
  const FrameTruth truth = frame_truth(targets, sensor, columns, {.first = 0, .count = 1});
  EXPECT_THAT(truth.metres, ElementsAre(IsNan(), IsNan(), IsNan(), 6.7F));
  EXPECT_EQ(truth.beyond_range, 2U);
  EXPECT_EQ(truth.dead, 1U);
  EXPECT_EQ(truth.sentences(sensor),
            " 2 pixels are beyond the sensor's range, 6.75 m (light there and back in 45 ns), and not judged."
            " 1 pixel is dead and not judged.");
  // A block of pixels has a distance though one of them is dead.
  sensor.binning = 2;
  EXPECT_EQ(frame_truth(targets, sensor, columns, {.first = 0, .count = 1}).dead, 0U);
}

TEST(FrameTruth, ACubeHasAFirstReturnBesideItsTruth) {
  // The truth at 3 m; an earlier return at 1.5 m, none, and one that is too near to the truth to tell.
  TargetMap targets(3, 1, {.depth_m = 3.0, .reflectivity = 1.0});
  auto cube = std::make_shared<TransientCube>(3, 1, TransientScale{.bin_width_s = 0.1e-9});
  std::vector<double> events(400, 0.0);
  events[200] = 3.0;
  cube->set(1, 0, events);
  events[100] = 1.0;
  cube->set(0, 0, events);
  events[100] = 0.0;
  events[185] = 1.0;
  cube->set(2, 0, events);
  const std::array<int, 3> columns = {0, 1, 2};
  EXPECT_TRUE(frame_truth(targets, SensorModel(), columns, {.first = 0, .count = 1}).first_return.empty());
  targets.set_cube(cube);
  SensorModel sensor;
  sensor.pulse_fwhm_s = 0.5e-9;
  const FrameTruth truth = frame_truth(targets, sensor, columns, {.first = 0, .count = 1});
  EXPECT_THAT(truth.metres, ElementsAre(3.0F, 3.0F, 3.0F));
  EXPECT_THAT(truth.first_return, ElementsAre(testing::FloatNear(1.5064F, 1e-3F), IsNan(), IsNan()));
}

TEST(Reachable, NeedsOneTargetInRange) {
  TargetMap targets(2, 1, {.depth_m = 10.0, .reflectivity = 1.0});
  EXPECT_EQ(
      refusal(targets),
      "a.npy: every pixel is beyond the sensor's range, 6.75 m (light there and back in 45 ns), the nearest "
      "at 10 m");
  targets.at(1, 0).depth_m = 1.0;
  EXPECT_EQ(refusal(targets), "");
  EXPECT_EQ(refusal(TargetMap(2, 1)), "a.npy: no pixel has a distance");
}

TEST(Reachable, AsksWhetherAMapHasMillimetres) {
  TargetMap targets(2, 1, {.depth_m = 2257.0, .reflectivity = 1.0});
  EXPECT_THAT(refusal(targets), HasSubstr("if these are millimetres, use --depth-scale 0.001"));
  EXPECT_THAT(refusal(targets, false), Not(HasSubstr("millimetres")));
  targets.at(1, 0).depth_m = 2257.5;
  EXPECT_THAT(refusal(targets), Not(HasSubstr("millimetres")));
  EXPECT_THAT(refusal(TargetMap(1, 1, {.depth_m = 7000.0, .reflectivity = 1.0})),
              Not(HasSubstr("millimetres")));
}

}  // namespace
}  // namespace dtof
