// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "dtof/photon/target_map.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// What happens in a video of a scene.
enum class Motion {
  kStill,   ///< nothing
  kPan,     ///< the camera turns to the right, `speed` columns per frame; maps come in from the right
  kRoll,    ///< the camera turns about its axis, `speed` degrees per frame; the room alone
  kObject,  ///< the sphere moves to the right, `speed` centimetres per frame; the room alone
  kCut,     ///< in the middle frame the scene becomes its mirror image
  kLight,   ///< from 2 to 50 klux, by the same factor from frame to frame
};

inline constexpr std::array<Motion, 6> kAllMotions = {Motion::kStill,  Motion::kPan, Motion::kRoll,
                                                      Motion::kObject, Motion::kCut, Motion::kLight};

/// Command-line name: still, pan, roll, object, cut, light.
std::string_view motion_name(Motion motion);
/// One sentence on what happens.
std::string_view motion_summary(Motion motion);
/// Throws InputError naming the legal names.
Motion parse_motion(std::string_view name);

/// Whether there is a video of this scene with this motion.
bool has_motion(Scene scene, Motion motion);

struct Sequence {
  Scene scene = Scene::kRoom;
  SceneParameters parameters;
  Motion motion = Motion::kStill;
  int frames = 16;     ///< at least 2
  double speed = 2.0;  ///< above 0; whole columns where a map that is no room pans
  double klux = 14.0;  ///< unless the light changes
};

/// The frame in which a cut shows the other scene first.
int cut_frame(const Sequence& sequence);

struct SequenceFrame {
  TargetMap targets;
  double klux = 0.0;
};

/// The `frame`-th, from 0. Throws InputError for numbers out of range and for a motion that the scene has
/// not.
SequenceFrame sequence_frame(const Sequence& sequence, int frame);

}  // namespace dtof
