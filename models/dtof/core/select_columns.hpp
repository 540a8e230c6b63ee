// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dtof/core/detection.hpp"

namespace dtof {

/// Returns the columns to read: those listed, in the order given, or all if `columns` is empty. Throws
/// InputError for a column that `source` does not have.
std::vector<int> select_columns(const StreamSource& source, std::span<const int> columns);

/// Neighbouring columns that are read together.
struct ColumnGroup {
  int first = 0;
  int count = 0;
  std::vector<std::size_t> asked;  ///< indices of the group's columns in the list of columns asked for
};

/// Returns the groups that contain a column of `selected`, from left to right. The array has `columns`
/// columns, of which each `together`, counted from column 0, form a group. Groups are always whole, so a
/// pixel's result does not depend on which columns are asked for.
std::vector<ColumnGroup> column_groups(std::span<const int> selected, int together, int columns);

}  // namespace dtof
