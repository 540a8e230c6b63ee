// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// Source of a read-out's array, and where the rows to read lie in it. Same for models and RTL.
struct ArrayRows {
  std::unique_ptr<StreamSource> source;
  int first;        ///< sensor row of row 0 of `source`
  RowRange region;  ///< rows to read, counted in `source`

  /// Cuts the results of `region` out of `frame`, the row-major results of the whole array.
  [[nodiscard]] std::vector<PixelResult> read(std::vector<PixelResult> frame) const;
};

/// Returns the array's source for a region of the sensor. Pixels of a pool read-out depend on their
/// neighbours, so its array is whole and dark outside the region. It has as many rows as `source`, at least
/// kArrayRows unless `own_rows`. All other read-outs get the region's rows alone. `source` must outlive the
/// result. Throws InputError for a region outside `source`.
ArrayRows array_rows(const StreamSource& source, RowRange region, Readout readout, bool own_rows = false);

}  // namespace dtof
