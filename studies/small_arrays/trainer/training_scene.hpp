// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/photon/target_map.hpp"

namespace dtof {

/// A map for training the learned enlarger. It has two to four slanted walls of random texture. In front of
/// them are 10 to 80 ellipses, boxes and bars of 1 to 100 pixels, upright or turned, flat or slanted, at 0.4
/// to 6 m. Textures are plain, stripes, squares or spots. Some shapes have the texture of the surface behind
/// them, so brightness is a hint of an edge but no proof. Depends on size, `seed` and `number` alone.
TargetMap make_training_scene(int columns, int rows, std::uint64_t seed, std::uint32_t number);

}  // namespace dtof
