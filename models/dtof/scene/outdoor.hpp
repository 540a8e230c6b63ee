// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/photon/target_map.hpp"

namespace dtof {

// Scenes that are difficult for read-outs that combine neighbouring pixels. Sizes are in pixels of the array,
// because the number of pixels on a surface matters. Random shapes depend on `seed` alone. All functions
// throw InputError unless columns and rows are at least 1.

/// 28 slanted planes side by side, 0.5 to 5 m. Each has its own reflectivity (0.1 to 0.9 times
/// `reflectivity`) and its own slope along the column.
TargetMap make_planes(int columns, int rows, double reflectivity, std::uint64_t seed);

/// Branches (1 to 3 pixels thick) and leaves at 1 to 3.5 m in front of a slanted ground at 3.5 to 4.5 m.
/// Eight neighbouring pixels often see more than three depths.
TargetMap make_clutter(int columns, int rows, double reflectivity, std::uint64_t seed);

/// Poles and wires of 1 to 3 pixels in all directions, at 0.8 to 3.5 m, in front of a wall at 4 m.
TargetMap make_poles(int columns, int rows, double reflectivity, std::uint64_t seed);

/// Single pixels at 3 m in front of a wall at 4 m, one every 20 rows of a column, staggered.
TargetMap make_isolated(int columns, int rows, double reflectivity);

/// Sky above a wall at 4 m. The sky returns no laser light and is as bright as a surface of `reflectivity`;
/// everything else has half of it. The wall's top is ragged by 8 rows around the middle. Every 34 columns,
/// three objects stand out into the sky: a box of 8 columns and 14 rows at 3 m, a pole of 1 column at 2 m and
/// one of 2 columns at 3 m.
TargetMap make_sky(int columns, int rows, double reflectivity);

}  // namespace dtof
