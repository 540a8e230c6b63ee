// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "dtof/design/design.hpp"

namespace dtof {

/// The read-outs that keep the limits, best first: what they cost and what they are worth.
std::string design_table(const DesignRequest& request, const DesignResult& result);

/// What is recommended, why, and the nearest competitor, in sentences.
std::string design_recommendation(const DesignRequest& request, const DesignResult& result);

/// The command that makes what is recommended.
std::string design_product(const DesignRequest& request, const DesignResult& result,
                           const std::string& sensor_name);

/// What 10 % more or less of each limit brings, a line each.
std::string design_consequences(const DesignRequest& request, const DesignResult& result);

/// The whole page as Markdown. `sensor_name`: as --sensor has it; `confirmed`: the flow's table, or empty.
std::string design_page(const DesignRequest& request, const DesignResult& result,
                        const std::string& sensor_name, const std::string& command_line,
                        const std::string& confirmed);

/// Pixels that are off against area, of every set of parameters that was read, with the limit of area.
void write_design_picture(const std::filesystem::path& path, const DesignRequest& request,
                          const DesignResult& result);

/// All that was read, as CSV.
std::string design_csv(const DesignRequest& request, const DesignResult& result);

}  // namespace dtof
