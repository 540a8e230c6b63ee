// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace dtof {

/// Unequal code widths of the sensor's TDCs (differential non-linearity), one table per TDC.
///
/// A table's widths repeat until all 2^NP codes have one, as the taps of a delay line repeat with its clock's
/// period. They are scaled so that the codes fill T_int: the mean width of a code is T_res. A width of 0
/// inside a table is a code that never occurs. Zeros at both ends of a table are taps beyond the period and
/// are dropped.
class TdcCodes {
 public:
  /// At least one table. Widths are in any unit, finite, at least 0, and not all 0. Throws InputError
  /// otherwise.
  explicit TdcCodes(std::vector<std::vector<double>> tables);

  [[nodiscard]] std::size_t tables() const { return tables_.size(); }
  /// Begins of a pixel's codes in units of T_res: 2^np + 1 ascending values from 0 to 2^np. `pixel` is row *
  /// columns + column; pixel i uses table i modulo tables().
  [[nodiscard]] std::vector<double> boundaries(std::size_t pixel, int np) const;

 private:
  std::vector<std::vector<double>> tables_;
};

}  // namespace dtof
