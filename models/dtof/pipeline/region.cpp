// SPDX-License-Identifier: Apache-2.0
#include "dtof/pipeline/region.hpp"

#include <cstddef>
#include <numeric>

namespace dtof {

Region Region::whole(int columns, int rows) {
  Region region{.columns = std::vector<int>(static_cast<std::size_t>(columns)),
                .rows = {.first = 0, .count = rows}};
  std::iota(region.columns.begin(), region.columns.end(), 0);
  return region;
}

}  // namespace dtof
