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

/// Sky, which returns nothing and is as bright as a surface of `reflectivity`, above a wall at 4 m of half of
/// it whose top is ragged by 8 rows around the middle. A pattern of 34 columns stands out into the sky: a box
/// of 8 columns and 14 rows above the middle at 3 m, a pole of 1 column at 2 m and one of 2 columns at 3 m,
/// each of half of `reflectivity`.
TargetMap make_sky(int columns, int rows, double reflectivity);

}  // namespace dtof
