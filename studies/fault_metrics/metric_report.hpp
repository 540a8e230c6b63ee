// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "fault_metrics/metric_study.hpp"
#include "fault_metrics/protection_cost.hpp"
#include "page/page.hpp"

namespace dtof {

struct MetricReport {
  PageData page;    ///< of fault_metrics.mustache
  std::string csv;  ///< a line per array, stratum and life of a fault
};

/// Goals of the protection.
inline constexpr double kDetectedGoal = 0.97;  ///< of the harmful faults, at least
inline constexpr double kAreaGoal = 0.04;      ///< of the array's area, at most

/// `costs`: by the name of the read-out; those that were not synthesised are missing.
MetricReport report_metrics(std::span<const ArrayResult> results,
                            const std::map<std::string, ProtectionCost>& costs,
                            const MetricStudyOptions& options, const std::string& command_line);

}  // namespace dtof
