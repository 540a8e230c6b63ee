// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "dtof/report/table.hpp"
#include "intervals/coverage_study.hpp"
#include "page/page.hpp"

namespace dtof {

/// What coverage_study.mustache shows.
PageData coverage_page(const CoverageSettings& settings, const CoverageStudy& study,
                       const std::string& command_line);

/// All cells of the study.
Table coverage_csv(const CoverageStudy& study);

/// Number of cells and stopping rules that fail.
std::size_t coverage_failures(const CoverageStudy& study);

}  // namespace dtof
