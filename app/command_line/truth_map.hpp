// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "run/region.hpp"

namespace dtof {

/// Adds --truth-scale, the metres per unit of the truth map.
void add_truth_scale_option(CLI::App& command, std::optional<double>& metres_per_unit);

/// True distances in m of a recording of columns x rows, from a depth map (io/depth_image.hpp). Index = row *
/// columns + column, NaN = unknown. The map has the size of the recording or of `region`; in the latter case
/// pixels outside `region` are unknown. Throws InputError that names the file, also for any other size or a
/// map without a distance.
std::vector<double> read_truth_map(const std::string& file, std::optional<double> metres_per_unit,
                                   int columns, int rows, const Region& region);

}  // namespace dtof
