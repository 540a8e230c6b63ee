// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

namespace dtof {

/// Number of pixels for each confidence value.
using ConfidenceCounts = std::map<int, std::uint64_t>;

/// Number of pixels whose confidence is at least `least_confidence`.
std::uint64_t count_from(const ConfidenceCounts& pixels, int least_confidence);

/// Lowest threshold, 0 or more, that at most `share` of the pixels reach; 0 without pixels. With the
/// confidences of pixels that see no target, `share` is the false-alarm rate of the threshold.
int lowest_threshold(const ConfidenceCounts& pixels, double share);

}  // namespace dtof
