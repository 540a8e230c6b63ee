// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

namespace dtof {

/// Share in per cent for a table, without sign: two digits below 10, whole numbers from 10.
inline std::string percent_text(double share) {
  const double value = 100.0 * share;
  return value == 0.0 ? "0" : value < 9.95 ? fmt::format("{:.2g}", value) : fmt::format("{:.0f}", value);
}

}  // namespace dtof
