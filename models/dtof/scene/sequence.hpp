// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "dtof/photon/target_map.hpp"
#include "dtof/scene/scene.hpp"

namespace dtof {

/// Change of a scene over the frames of a video.
enum class Motion {
  kStill,  ///< nothing
  kPan,    ///< the camera turns right by `speed` columns per frame; scenes other than the room scroll in from
           ///< the right
  kRoll,   ///< the camera turns about its axis by `speed` degrees per frame; room only
  kObject,  ///< the sphere moves right by `speed` centimetres per frame; room only
  kCut,     ///< the scene becomes its mirror image in the middle frame
  kLight,   ///< light rises from 2 to 50 klux, by the same factor per frame
};

inline constexpr std::array<Motion, 6> kAllMotions = {Motion::kStill,  Motion::kPan, Motion::kRoll,
                                                      Motion::kObject, Motion::kCut, Motion::kLight};

/// Command-line name: still, pan, roll, object, cut, light.
std::string_view motion_name(Motion motion);
/// One sentence that describes the motion.
std::string_view motion_summary(Motion motion);
/// Motion by its command-line name. Throws InputError that lists the known names.
Motion parse_motion(std::string_view name);

/// True if this scene can have this motion.
bool has_motion(Scene scene, Motion motion);

struct Sequence {
  Scene scene = Scene::kRoom;
  SceneParameters parameters;
  Motion motion = Motion::kStill;
  int frames = 16;     ///< at least 2
  double speed = 2.0;  ///< above 0; a whole number of columns if a scene other than the room pans
  double klux = 14.0;  ///< constant light, unless the motion is kLight
};

/// Number of the first frame after a cut.
int cut_frame(const Sequence& sequence);

struct SequenceFrame {
  TargetMap targets;
  double klux = 0.0;
};

/// Frame number `frame`, from 0. Throws InputError for numbers out of range, or if the scene cannot have the
/// motion.
SequenceFrame sequence_frame(const Sequence& sequence, int frame);

}  // namespace dtof
