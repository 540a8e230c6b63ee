// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "dtof/design/design.hpp"

namespace dtof {

/// Plots the share of errors above 3 % against area for all parameters that were read out, with the limit of
/// area. Rivals have no area, and are left out.
void write_design_picture(const std::filesystem::path& path, const DesignRequest& request,
                          const DesignResult& result);

}  // namespace dtof
