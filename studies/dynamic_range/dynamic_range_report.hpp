// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "dynamic_range/dynamic_range.hpp"

namespace dtof {

/// The study in Markdown: what is wrong first. Every sentence that states a result is computed from `study`.
std::string dynamic_range_report(const RangeSettings& settings, const DynamicRange& study,
                                 const std::string& command_line);

/// Every cell and read-out.
Table dynamic_range_csv(const DynamicRange& study);

/// The light that the picture shows: the middle one of the settings.
double pictured_klux(const RangeSettings& settings);
/// Share above 3 % over acquisitions at that light and the signal nearest to the sensor's.
std::vector<PlotSeries> dynamic_range_curves(const RangeSettings& settings, const DynamicRange& study);

/// Findings about pool read-outs, of all three lists.
std::size_t pool_findings(const DynamicRange& study);

}  // namespace dtof
