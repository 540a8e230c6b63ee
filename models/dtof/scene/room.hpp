// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// Direction of the camera, and displacement of the sphere.
struct RoomView {
  double pan_degrees = 0.0;     ///< about the vertical axis, to the right
  double roll_degrees = 0.0;    ///< about the optical axis
  double sphere_right_m = 0.0;  ///< displacement of the sphere to the right
};

/// The `room` scene by ray casting. The field of view is always 96 x 76.8 degrees (200 x 160 pixels of AFOV
/// 0.48). The projection is equiangular for any number of pixels: column and row turn the ray.
TargetMap make_room(int columns, int rows, double reflectivity, const RoomView& view = {});

}  // namespace dtof
