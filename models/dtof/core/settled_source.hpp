// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Another source's streams without the first `settle` acquisitions, in which a laser settles. Models the
/// register SETTLE (docs/user/integration.md).
class SettledSource final : public StreamSource {
 public:
  /// Throws InputError if no acquisition is left.
  SettledSource(std::unique_ptr<StreamSource> source, std::uint32_t settle);

  [[nodiscard]] int columns() const override { return source_->columns(); }
  [[nodiscard]] int rows() const override { return source_->rows(); }
  [[nodiscard]] std::uint32_t acquisitions() const override { return source_->acquisitions() - settle_; }
  [[nodiscard]] ColumnStream column(int index) const override {
    return without_first(source_->column(index), settle_);
  }
  [[nodiscard]] ColumnStream column_rows(int index, RowRange rows) const override {
    return without_first(source_->column_rows(index, rows), settle_);
  }

 private:
  std::unique_ptr<StreamSource> source_;
  std::uint32_t settle_;
};

}  // namespace dtof
