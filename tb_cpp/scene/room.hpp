// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "photon/target_map.hpp"

namespace dtof {

/// The `room` scene by ray casting. The array always sees 96 x 76.8 degrees (200 x 160 pixels of AFOV 0.48),
/// equiangular: column and row turn the ray, whatever the number of pixels.
TargetMap make_room(int columns, int rows, double reflectivity);

}  // namespace dtof
