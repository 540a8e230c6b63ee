// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "dynamic_range/dynamic_range.hpp"
#include "page/page.hpp"

namespace dtof {

/// Data of the page dynamic_range.mustache.
PageData dynamic_range_page(const RangeSettings& settings, const DynamicRange& study,
                            const std::string& command_line);

/// All cells and read-outs.
Table dynamic_range_csv(const DynamicRange& study);

/// Light level of the picture: the middle one of the settings.
double pictured_klux(const RangeSettings& settings);
/// Share of errors above 3 % against acquisitions, at that light level and the signal nearest to the
/// sensor's.
std::vector<PlotSeries> dynamic_range_curves(const RangeSettings& settings, const DynamicRange& study);

/// Number of findings about pool read-outs in all three lists.
std::size_t pool_findings(const DynamicRange& study);

}  // namespace dtof
