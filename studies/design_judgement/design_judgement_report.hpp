// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "design_judgement/design_judgement.hpp"
#include "dtof/report/plot.hpp"
#include "dtof/report/table.hpp"
#include "page/page.hpp"

namespace dtof {

/// Data of the page design_judgement.mustache.
PageData judgement_page(const JudgementSettings& settings, const std::vector<JudgedSensor>& judged,
                        const std::string& command_line);
/// A line for each sensor.
Table judgement_csv(const std::vector<JudgedSensor>& judged);
/// Share of the recommendation against the best share, with the line of equal shares.
std::vector<PlotSeries> judgement_curves(const std::vector<JudgedSensor>& judged);

}  // namespace dtof
