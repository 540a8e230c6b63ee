// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace dtof {

/// Unequal code widths of the sensor's TDCs (differential non-linearity), one table per TDC.
///
/// A table's widths repeat until all 2^NP codes have one, as a delay line's do with every period of its
/// clock, and are scaled so that the codes fill T_int: the mean width of a code is T_res. Widths of 0 in
/// between are codes that never appear; those at both ends of a table are taps that the period does not reach
/// and are left out.
class TdcCodes {
 public:
  /// At least one table; widths in any unit, finite, at least 0, not all 0. Throws InputError.
  explicit TdcCodes(std::vector<std::vector<double>> tables);

  [[nodiscard]] std::size_t tables() const { return tables_.size(); }
  /// Where the codes of a pixel begin, in units of T_res: 2^np + 1 ascending values from 0 to 2^np. `pixel`
  /// is row * columns + column; pixel i has table i modulo their number.
  [[nodiscard]] std::vector<double> boundaries(std::size_t pixel, int np) const;

 private:
  std::vector<std::vector<double>> tables_;
};

}  // namespace dtof
