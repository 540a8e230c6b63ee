// SPDX-License-Identifier: Apache-2.0
#include "core/select_columns.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numeric>

#include "core/error.hpp"

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

}  // namespace dtof
