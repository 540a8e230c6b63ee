// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/detection.hpp"

#include <fmt/format.h>

#include "dtof/core/error.hpp"

namespace dtof {

ColumnStream StreamSource::column_rows(int index, RowRange rows) const {
  const ColumnStream whole = column(index);
  const int end = rows.first + rows.count;
  if (whole.rows() < end) {
    throw InputError(fmt::format("column {} has {} rows, not {}", index, whole.rows(), end));
  }
  ColumnStream part;
  for (int row = rows.first; row < end; ++row) {
    part.append_row(whole.row(row));
  }
  return part;
}

}  // namespace dtof
