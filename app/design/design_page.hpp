// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dtof/design/design.hpp"
#include "dtof/report/table.hpp"

namespace dtof {

/// Table of the read-outs within the limits, best first: cost and error figures.
Table design_rows(const DesignRequest& request, const DesignResult& result);

/// Table of the rivals that were read, best first: error figures and memory. Other costs say "not estimated".
Table design_rival_rows(const DesignResult& result);

/// That table, the reason why costs are not estimated, and how many rivals are left out; empty without
/// rivals.
std::string design_rivals(const DesignResult& result);

/// Sentence that names the rivals that are more accurate than the recommended read-out; empty without rivals.
std::string design_more_accurate(const DesignResult& result);

/// Sentences on the recommended read-out, the reason, and the nearest competitor.
std::string design_recommendation(const DesignRequest& request, const DesignResult& result);

/// Command that makes the recommended read-out.
std::string design_product(const DesignRequest& request, const DesignResult& result,
                           const std::string& sensor_name);

/// One line per limit on the effect of 10 % more or less.
std::string design_consequences(const DesignRequest& request, const DesignResult& result);

/// For each read-out within the limits, best first, a sentence on the clocks of its frame.
std::vector<std::string> design_clocks(const DesignRequest& request, const DesignResult& result);

/// The whole page as Markdown. `sensor_name`: value of --sensor. `confirmed`: table of the synthesis flow, or
/// empty.
std::string design_page(const DesignRequest& request, const DesignResult& result,
                        const std::string& sensor_name, const std::string& command_line,
                        const std::string& confirmed);

/// All options and rivals that were read out, as CSV.
std::string design_csv(const DesignRequest& request, const DesignResult& result);

}  // namespace dtof
