// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// How the sensor looks at the room, and what moved in it since.
struct RoomView {
  double pan_degrees = 0.0;     ///< about the vertical axis, to the right
  double roll_degrees = 0.0;    ///< about the optical axis
  double sphere_right_m = 0.0;  ///< how far the sphere has moved
};

/// The `room` scene by ray casting. The array always sees 96 x 76.8 degrees (200 x 160 pixels of AFOV 0.48),
/// equiangular: column and row turn the ray, whatever the number of pixels.
TargetMap make_room(int columns, int rows, double reflectivity, const RoomView& view = {});

}  // namespace dtof
