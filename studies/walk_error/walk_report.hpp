// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "page/page.hpp"
#include "walk_error/walk_study.hpp"

namespace dtof {

/// A row per read-out, over all its points.
Table walk_summary(const std::vector<WalkReadout>& readouts);
/// What walk_error.mustache shows.
PageData walk_page(const WalkSettings& settings, const std::vector<WalkReadout>& readouts,
                   const std::string& command_line);
/// All points.
Table walk_csv(const std::vector<WalkReadout>& readouts);
/// Bias in mm against reflectivity at the nearest distance: before the correction, and after the correction
/// where it halves the walk.
std::vector<PlotSeries> walk_curves(const WalkSettings& settings, const std::vector<WalkReadout>& readouts);

}  // namespace dtof
