// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

namespace dtof {

/// Pixels of each confidence.
using ConfidenceCounts = std::map<int, std::uint64_t>;

/// Pixels of at least this confidence.
std::uint64_t count_from(const ConfidenceCounts& pixels, int least_confidence);

/// The lowest confidence, 0 or more, that at most `share` of the pixels reach: what tells a target from a
/// sky, if the pixels are a sky's and the share is that of false alarms. 0 without pixels.
int lowest_threshold(const ConfidenceCounts& pixels, double share);

}  // namespace dtof
