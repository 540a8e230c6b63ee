// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace dtof {

/// Red, green, blue, each 0..1.
using Colour = std::array<double, 3>;

/// Viridis (van der Walt and Smith), a perceptually uniform map, as the degree-6 polynomial fit of M. Zucker
/// (CC0). `position` is clamped to 0..1.
Colour viridis(double position);

/// Blue (0) over white (0.5) to red (1): ColorBrewer's RdBu, linear between its nodes. Clamped to 0..1.
Colour blue_white_red(double position);

}  // namespace dtof
