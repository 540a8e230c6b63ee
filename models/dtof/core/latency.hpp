// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/core/parameters.hpp"

namespace dtof {

/// Clocks from a frame's last timestamps on the port to done: how long after the last photon the map is
/// complete. Assumes the same array, source and sink as predicted_frame_clocks(), and a frame whose last
/// measurement has acquisitions.
std::uint64_t predicted_latency_clocks(const ReadoutParameters& parameters, int rows, int columns);

}  // namespace dtof
