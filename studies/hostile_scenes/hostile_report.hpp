// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "hostile_scenes/hostile_scenes.hpp"
#include "page/page.hpp"

namespace dtof {

/// Conditions, e.g. "late-laser (14, 50 klux)", in which an estimator has more than twice the coarse
/// histogram's share of errors above 3 %, beyond both intervals. Empty without a coarse histogram.
/// `compensated`: both with the additional knowledge of HostileScenes::compensated.
std::vector<std::string> behind_coarse_histogram(const HostileSettings& settings, const HostileScenes& study,
                                                 const std::string& estimator, bool compensated);

/// Conditions in which every read-out has more than a tenth of its errors above 10 %, with the share of the
/// best read-out.
std::vector<std::string> fooled_together(const HostileSettings& settings, const HostileScenes& study);

/// What hostile_scenes.mustache shows.
PageData hostile_page(const HostileSettings& settings, const HostileScenes& study,
                      const std::string& command_line);
/// All estimators in all conditions, with intervals.
Table hostile_csv(const HostileSettings& settings, const HostileScenes& study);
/// Share detected against false alarms, in clear conditions at the brightest light, for every estimator whose
/// confidence has more than one value.
std::vector<PlotSeries> hostile_curves(const HostileSettings& settings, const HostileScenes& study);

}  // namespace dtof
