// SPDX-License-Identifier: Apache-2.0
#include "dtof/core/select_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

#include "dtof/core/error.hpp"

namespace dtof {

std::vector<int> select_columns(const StreamSource& source, std::span<const int> columns) {
  std::vector<int> selected(columns.begin(), columns.end());
  if (columns.empty()) {
    selected.resize(static_cast<std::size_t>(source.columns()));
    std::iota(selected.begin(), selected.end(), 0);
  }
  for (const int column : selected) {
    if (column < 0 || column >= source.columns()) {
      throw InputError(
          fmt::format("column {} is outside the source's 0 to {}", column, source.columns() - 1));
    }
  }
  return selected;
}

std::vector<ColumnGroup> column_groups(std::span<const int> selected, int together, int columns) {
  std::map<int, ColumnGroup> by_first;
  for (std::size_t i = 0; i < selected.size(); ++i) {
    const int first = selected[i] / together * together;
    ColumnGroup& group = by_first[first];
    group.first = first;
    group.count = std::min(together, columns - first);
    group.asked.push_back(i);
  }
  std::vector<ColumnGroup> groups;
  groups.reserve(by_first.size());
  for (auto& [first, group] : by_first) {
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace dtof
