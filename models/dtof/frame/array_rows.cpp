// SPDX-License-Identifier: Apache-2.0
#include "dtof/frame/array_rows.hpp"

#include <algorithm>

#include "dtof/core/row_region.hpp"

namespace dtof {

std::vector<PixelResult> ArrayRows::read(std::vector<PixelResult> frame) const {
  const auto width = static_cast<std::ptrdiff_t>(frame.size()) / source->rows();
  frame.erase(frame.begin() + width * (region.first + region.count), frame.end());
  frame.erase(frame.begin(), frame.begin() + width * region.first);
  return frame;
}

ArrayRows array_rows(const StreamSource& source, RowRange region, Readout readout, bool own_rows) {
  if (!is_pool_readout(readout)) {
    return {row_region(source, region), region.first, {.first = 0, .count = region.count}};
  }
  const int rows = own_rows ? source.rows() : std::max(source.rows(), kArrayRows);
  return {dark_except(source, region, rows), 0, region};
}

}  // namespace dtof
