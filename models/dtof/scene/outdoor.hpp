// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/photon/target_map.hpp"

namespace dtof {

// Scenes that are hard on read-outs that pool neighbouring pixels. Sizes are in pixels of the array, since
// what matters is how many pixels of a column share a surface; random shapes depend on `seed` alone.

/// 28 slanted planes side by side, each with its own reflectivity (0.1 to 0.9 of `reflectivity`) and its own
/// slope along the column, 0.5 to 5 m.
TargetMap make_planes(int columns, int rows, double reflectivity, std::uint64_t seed);

/// Branches (1 to 3 pixels thick) and leaves, 1 to 3.5 m, before a slanted ground at 3.5 to 4.5 m: often more
/// than three depths in eight pixels.
TargetMap make_clutter(int columns, int rows, double reflectivity, std::uint64_t seed);

/// Poles and wires of 1 to 3 pixels in all directions, 0.8 to 3.5 m, before a wall at 4 m.
TargetMap make_poles(int columns, int rows, double reflectivity, std::uint64_t seed);

/// Single pixels at 3 m before a wall at 4 m, one every 20 rows of a column, staggered.
TargetMap make_isolated(int columns, int rows, double reflectivity);

}  // namespace dtof
