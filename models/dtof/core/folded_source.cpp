// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/folded_source.hpp"

#include <fmt/format.h>

#include "dtof/core/error.hpp"

namespace dtof {

FoldedSource::FoldedSource(const StreamSource& sensor, int columns_per_sram)
    : sensor_(&sensor), columns_per_sram_(columns_per_sram) {
  if (columns_per_sram < 1 || columns_per_sram > sensor.columns()) {
    throw InputError(fmt::format("{} columns for each SRAM, must be 1 to the sensor's {} columns",
                                 columns_per_sram, sensor.columns()));
  }
}

ColumnStream FoldedSource::column(int index) const {
  ColumnStream folded;
  for (int i = 0; i < columns_per_sram_; ++i) {
    const int column = index * columns_per_sram_ + i;
    const ColumnStream stream = column < sensor_->columns() ? sensor_->column(column) : ColumnStream();
    for (int row = 0; row < sensor_->rows(); ++row) {
      folded.append_row(column < sensor_->columns() ? stream.row(row) : std::span<const Detection>());
    }
  }
  return folded;
}

}  // namespace dtof
