// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "dtof/design/design.hpp"

namespace dtof {

/// Table of the read-outs within the limits, best first: cost and error figures.
std::string design_table(const DesignRequest& request, const DesignResult& result);

/// Sentences on the recommended read-out, the reason, and the nearest competitor.
std::string design_recommendation(const DesignRequest& request, const DesignResult& result);

/// Command that makes the recommended read-out.
std::string design_product(const DesignRequest& request, const DesignResult& result,
                           const std::string& sensor_name);

/// One line per limit on the effect of 10 % more or less.
std::string design_consequences(const DesignRequest& request, const DesignResult& result);

/// The whole page as Markdown. `sensor_name`: value of --sensor. `confirmed`: table of the synthesis flow, or
/// empty.
std::string design_page(const DesignRequest& request, const DesignResult& result,
                        const std::string& sensor_name, const std::string& command_line,
                        const std::string& confirmed);

/// Plots the share of errors above 3 % against area for all parameters that were read out, with the limit of
/// area.
void write_design_picture(const std::filesystem::path& path, const DesignRequest& request,
                          const DesignResult& result);

/// All options that were read out, as CSV.
std::string design_csv(const DesignRequest& request, const DesignResult& result);

}  // namespace dtof
