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

ColumnStream without_first(const ColumnStream& stream, std::uint32_t acquisitions) {
  ColumnStream rest;
  rest.reserve(stream.detection_count());
  for (int row = 0; row < stream.rows(); ++row) {
    for (const Detection& detection : stream.row(row)) {
      if (detection.acquisition >= acquisitions) {
        rest.append({detection.acquisition - acquisitions, detection.timestamp});
      }
    }
    rest.finish_row();
  }
  return rest;
}

}  // namespace dtof
