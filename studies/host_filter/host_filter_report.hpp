// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "host_filter/host_filter_study.hpp"
#include "page/page.hpp"

namespace dtof {

/// The goal of the project: light, read-out and largest share above 3 % after the filter, whole maps of all
/// scenes together.
inline constexpr double kFilterGoalKlux = 50.0;
inline constexpr double kFilterGoal = 0.005;

struct HostFilterReport {
  HostFilterSettings settings;
  std::vector<FilterLight> lights;
  std::vector<FilterLight> whole;  ///< poolPointer on whole maps, for the goal; may be empty
  std::string command_line;
};

/// Each read-out's figures over all scenes, before and after the filter.
Table host_filter_table(const FilterLight& light);
/// "yes" if the interval lies below the limit, "open" if the limit is inside, else "**no**".
const char* goal_verdict(const Estimate& share, double limit);
/// What host_filter.mustache shows.
PageData host_filter_page(const HostFilterReport& report);
Table host_filter_csv(const HostFilterReport& report);
/// Pixels above 3 % over the light, before and after the filter; empty for fewer than two lights.
std::vector<PlotSeries> host_filter_curves(const HostFilterReport& report);

}  // namespace dtof
