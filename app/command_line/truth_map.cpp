// SPDX-License-Identifier: Apache-2.0
#include "command_line/truth_map.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "command_line/option_checks.hpp"
#include "dtof/core/error.hpp"
#include "dtof/io/depth_image.hpp"

namespace dtof {

void add_truth_scale_option(CLI::App& command, std::optional<double>& metres_per_unit) {
  command
      .add_option("--truth-scale", metres_per_unit,
                  "metres that one unit of the truth map stands for (default: 0.001 for a PNG of 16 bits, 1\n"
                  "for PFM and NPY; a PNG of 8 bits needs it)")
      ->check(above_zero());
}

std::vector<double> read_truth_map(const std::string& file, std::optional<double> metres_per_unit,
                                   int columns, int rows, const Region& region) {
  const DepthImage map = read_depth_image(file, metres_per_unit);
  const auto region_columns = static_cast<int>(region.columns.size());
  const bool whole = map.width == columns && map.height == rows;
  if (!whole && (map.width != region_columns || map.height != region.rows.count)) {
    const bool part = region_columns != columns || region.rows.count != rows;
    throw InputError(
        fmt::format("{}: the truth map has {} x {} pixels, but the recording has {} x {}{}", file, map.width,
                    map.height, columns, rows,
                    part ? fmt::format(" and the region {} x {}", region_columns, region.rows.count) : ""));
  }
  if (std::ranges::all_of(map.metres, [](float metres) { return metres == 0.0F; })) {
    throw InputError(fmt::format("{}: no pixel of the truth map has a distance", file));
  }
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> truth(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kUnknown);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const int row = whole ? y : region.rows.first + y;
      const int column = whole ? x : region.columns[static_cast<std::size_t>(x)];
      const float metres = map.at(x, y);
      if (metres > 0.0F) {
        truth[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(column)] = metres;
      }
    }
  }
  return truth;
}

}  // namespace dtof
