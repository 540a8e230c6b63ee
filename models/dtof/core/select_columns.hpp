// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// The columns of `source` to read: those listed, in that order, or all if none is. Throws InputError for one
/// that the source does not have.
std::vector<int> select_columns(const StreamSource& source, std::span<const int> columns);

/// Neighbouring columns that are read together, and which of them are asked for.
struct ColumnGroup {
  int first = 0;
  int count = 0;
  std::vector<std::size_t> asked;  ///< places in the list of columns asked for
};

/// The groups that have a column of `selected`, from left to right, of an array of `columns` columns of which
/// `together` at a time hear each other, counted from column 0. Groups are whole, so that a pixel's result
/// does not depend on which columns are asked for, nor on their order.
std::vector<ColumnGroup> column_groups(std::span<const int> selected, int together, int columns);

}  // namespace dtof
