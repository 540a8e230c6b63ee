// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/detection.hpp"

namespace dtof {

/// The columns of `source` to read: those listed, in that order, or all if none is. Throws InputError for one
/// that the source does not have.
std::vector<int> select_columns(const StreamSource& source, std::span<const int> columns);

}  // namespace dtof
