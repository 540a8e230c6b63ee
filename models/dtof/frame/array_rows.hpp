// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "dtof/core/detection.hpp"
#include "dtof/core/parameters.hpp"
#include "dtof/core/result.hpp"

namespace dtof {

/// What a read-out's array sees of the rows that are read, the same for either engine.
struct ArrayRows {
  std::unique_ptr<StreamSource> source;
  int first;        ///< sensor row of the source's row 0
  RowRange region;  ///< the rows that are read, in the source

  /// The results of those rows, of a row-major frame of all that the array has.
  [[nodiscard]] std::vector<PixelResult> read(std::vector<PixelResult> frame) const;
};

/// Pixels of a pool read-out look at their neighbours, so its arrays are whole: of as many rows as the
/// thesis's (kArrayRows) or, with `own_rows`, as the source, those outside the region dark. All other pixels
/// are independent, and the region's rows are enough. `source` must outlive the result. Throws InputError for
/// a region outside it.
ArrayRows array_rows(const StreamSource& source, RowRange region, Readout readout, bool own_rows = false);

}  // namespace dtof
