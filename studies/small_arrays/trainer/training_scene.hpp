// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// A map that only the training of the learned enlarger uses: two to four walls, slanted and of random
/// texture, and before them 10 to 80 ellipses, boxes and bars of 1 to 100 pixels, upright or turned, flat or
/// slanted, from 0.4 to 6 m. Textures are plain, stripes, squares or spots, and some shapes have the texture
/// of what lies behind them, so that brightness is a hint of an edge, but no proof. All follows from `seed`
/// and `number` alone.
TargetMap make_training_scene(int columns, int rows, std::uint64_t seed, std::uint32_t number);

}  // namespace dtof
