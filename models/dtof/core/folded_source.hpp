// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Streams for an array in which several columns of the sensor share an SRAM. Column c of the array has the
/// rows of the sensor's columns c k to c k + k - 1, one column after the other; k = `columns_per_sram`.
/// Columns beyond the sensor's last column detect nothing. Refers to `sensor`.
class FoldedSource final : public StreamSource {
 public:
  /// Throws InputError unless `columns_per_sram` is 1 to the sensor's columns.
  FoldedSource(const StreamSource& sensor, int columns_per_sram);

  [[nodiscard]] int columns() const override {
    return (sensor_->columns() + columns_per_sram_ - 1) / columns_per_sram_;
  }
  [[nodiscard]] int rows() const override { return sensor_->rows() * columns_per_sram_; }
  [[nodiscard]] std::uint32_t acquisitions() const override { return sensor_->acquisitions(); }
  [[nodiscard]] ColumnStream column(int index) const override;

 private:
  const StreamSource* sensor_;
  int columns_per_sram_;
};

}  // namespace dtof
