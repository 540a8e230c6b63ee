// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "faults/fault_study.hpp"
#include "page/page.hpp"

namespace dtof {

struct FaultReport {
  PageData page;    ///< of faults.mustache
  std::string csv;  ///< a line per case
};

FaultReport report_faults(std::span<const FaultCaseResult> results, const FaultStudyOptions& options,
                          const std::string& command_line);

/// True if faults behave as expected: every frame ended, no fault affected another column, faulty timestamps
/// gave the model's results, and every frame after a fault was correct.
bool faults_stay_where_they_are(std::span<const FaultCaseResult> results);

}  // namespace dtof
