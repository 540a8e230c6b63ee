// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "run/region.hpp"

namespace dtof {

/// --truth-scale, metres that one unit of the truth map stands for.
void add_truth_scale_option(CLI::App& command, std::optional<double>& metres_per_unit);

/// True distances of a recording of columns x rows from a depth map (io/depth_image.hpp), m; index = row *
/// columns + column, NaN = unknown. The map has the size of the recording, or of the region that is read;
/// pixels outside that region are then unknown. Throws InputError that names the file, also for any other
/// size or a map without a distance.
std::vector<double> read_truth_map(const std::string& file, std::optional<double> metres_per_unit,
                                   int columns, int rows, const Region& region);

}  // namespace dtof
