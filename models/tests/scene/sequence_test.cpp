// SPDX-License-Identifier: Apache-2.0
#include "dtof/scene/sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "dtof/core/error.hpp"

namespace dtof {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Sequence sequence(Scene scene, Motion motion, double speed = 2.0) {
  Sequence made;
  made.scene = scene;
  made.motion = motion;
  made.frames = 6;
  made.speed = speed;
  made.parameters.columns = 60;
  made.parameters.rows = 48;
  return made;
}

TargetMap frame(const Sequence& made, int number) { return sequence_frame(made, number).targets; }

/// Pixels of two maps whose depths differ by more than a millimetre.
std::size_t different(const TargetMap& a, const TargetMap& b, int shift = 0) {
  std::size_t count = 0;
  for (int column = 0; column + shift < a.columns(); ++column) {
    for (int row = 0; row < a.rows(); ++row) {
      count += std::abs(a.at(column + shift, row).depth_m - b.at(column, row).depth_m) > 1e-3 ? 1U : 0U;
    }
  }
  return count;
}

TEST(Sequence, NamesAreParsedBack) {
  for (const Motion motion : kAllMotions) {
    EXPECT_EQ(parse_motion(motion_name(motion)), motion);
    EXPECT_FALSE(motion_summary(motion).empty());
  }
  EXPECT_THAT([] { parse_motion("zoom"); }, ThrowsMessage<InputError>(HasSubstr("zoom")));
}

TEST(Sequence, TheFirstFrameIsTheScene) {
  for (const Motion motion : kAllMotions) {
    const Sequence made = sequence(Scene::kRoom, motion);
    EXPECT_EQ(frame(made, 0), make_scene(Scene::kRoom, made.parameters)) << motion_name(motion);
  }
  const Sequence made = sequence(Scene::kPoles, Motion::kStill);
  EXPECT_EQ(frame(made, 5), make_scene(Scene::kPoles, made.parameters));
}

TEST(Sequence, MapsPanByWholeColumns) {
  const Sequence made = sequence(Scene::kClutter, Motion::kPan, 3.0);
  EXPECT_EQ(different(frame(made, 1), frame(made, 2), 0) > 100, true);
  EXPECT_EQ(different(frame(made, 1), frame(made, 2), 3), 0U);
  EXPECT_THAT([&] { (void)frame(sequence(Scene::kClutter, Motion::kPan, 1.5), 0); },
              ThrowsMessage<InputError>(HasSubstr("whole columns per frame, not by 1.5")));
}

// them.
TEST(Sequence, TheRoomTurns) {
  Sequence made = sequence(Scene::kRoom, Motion::kPan, 10.0);
  // Along the middle row a turn about the vertical axis shifts the picture.
  made.parameters.rows = 1;
  made.parameters.columns = 200;
  EXPECT_EQ(different(frame(made, 1), frame(made, 2), 10), 0U);
  EXPECT_GT(different(frame(made, 1), frame(made, 2)), 50U);

  const Sequence roll = sequence(Scene::kRoom, Motion::kRoll, 180.0);
  const TargetMap upright = frame(roll, 0);
  const TargetMap turned = frame(roll, 1);
  std::size_t unlike = 0;
  for (int column = 0; column < 60; ++column) {
    // The middle rows: a roll by half a turn looks at the other side.
    for (const int row : {23, 24}) {
      unlike += std::abs(turned.at(column, row).depth_m - upright.at(59 - column, 47 - row).depth_m) > 1e-6;
    }
  }
  EXPECT_EQ(unlike, 0U);
}

TEST(Sequence, OnlyTheSphereMoves) {
  const Sequence made = sequence(Scene::kRoom, Motion::kObject, 10.0);
  const std::size_t changed = different(frame(made, 0), frame(made, 1));
  EXPECT_GT(changed, 20U);
  EXPECT_LT(changed, 600U) << "more than the sphere's borders";
}

TEST(Sequence, ACutMirrorsTheSecondHalf) {
  const Sequence made = sequence(Scene::kPlanes, Motion::kCut);
  EXPECT_EQ(cut_frame(made), 3);
  EXPECT_EQ(frame(made, 2), frame(made, 0));
  EXPECT_EQ(frame(made, 5), frame(made, 3));
  EXPECT_EQ(frame(made, 3).at(0, 7), frame(made, 2).at(59, 7));
}

TEST(Sequence, LightRisesByAFactor) {
  const Sequence made = sequence(Scene::kRoom, Motion::kLight);
  EXPECT_DOUBLE_EQ(sequence_frame(made, 0).klux, 2.0);
  EXPECT_NEAR(sequence_frame(made, 5).klux, 50.0, 1e-9);
  EXPECT_NEAR(sequence_frame(made, 2).klux / sequence_frame(made, 1).klux, std::pow(25.0, 0.2), 1e-9);
  EXPECT_DOUBLE_EQ(sequence_frame(sequence(Scene::kRoom, Motion::kStill), 5).klux, 14.0);
}

TEST(Sequence, WhatASceneHasNotIsRefused) {
  EXPECT_THAT([] { (void)frame(sequence(Scene::kPlanes, Motion::kObject), 0); },
              ThrowsMessage<InputError>(HasSubstr("motion object is one of the room, not of scene planes")));
  EXPECT_THAT([] { (void)frame(sequence(Scene::kRoom, Motion::kStill), 6); },
              ThrowsMessage<InputError>(HasSubstr("frame 6 is none of its 6")));
  EXPECT_THAT([] { (void)frame(sequence(Scene::kRoom, Motion::kPan, 0.0), 0); },
              ThrowsMessage<InputError>(HasSubstr("speed must be above 0")));
}

}  // namespace
}  // namespace dtof
