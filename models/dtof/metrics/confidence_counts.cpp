// SPDX-License-Identifier: Apache-2.0
#include "dtof/metrics/confidence_counts.hpp"

namespace dtof {

std::uint64_t count_from(const ConfidenceCounts& pixels, int least_confidence) {
  std::uint64_t sum = 0;
  for (auto place = pixels.lower_bound(least_confidence); place != pixels.end(); ++place) {
    sum += place->second;
  }
  return sum;
}

int lowest_threshold(const ConfidenceCounts& pixels, double share) {
  const double allowed = share * static_cast<double>(count_from(pixels, 0));
  std::uint64_t reaching = 0;
  for (auto place = pixels.rbegin(); place != pixels.rend(); ++place) {
    reaching += place->second;
    if (static_cast<double>(reaching) > allowed) {
      return place->first + 1;
    }
  }
  return 0;
}

}  // namespace dtof
