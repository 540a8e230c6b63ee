// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "hostile_scenes/hostile_scenes.hpp"

namespace dtof {

/// Conditions, as "late-laser (14, 50 klux)", under which an estimator has more than twice the coarse
/// histogram's errors above 3 %, beyond both intervals; empty without a coarse histogram. With `told` both
/// are told what they can be told.
std::vector<std::string> behind_coarse_histogram(const HostileSettings& settings, const HostileScenes& study,
                                                 const std::string& estimator, bool told);

/// Conditions under which every read-out has more than a tenth of its pixels above 10 %, with the best one's
/// share.
std::vector<std::string> fooled_together(const HostileSettings& settings, const HostileScenes& study);

/// Markdown, the answer first.
std::string hostile_report(const HostileSettings& settings, const HostileScenes& study,
                           const std::string& command_line);
/// Every estimator under every condition, with intervals.
Table hostile_csv(const HostileSettings& settings, const HostileScenes& study);
/// Detected over false alarms in clear conditions at the brightest light, of every estimator whose confidence
/// has more than one value.
std::vector<PlotSeries> hostile_curves(const HostileSettings& settings, const HostileScenes& study);

}  // namespace dtof
