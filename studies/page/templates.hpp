// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace dtof {

struct PageTemplate {
  std::string_view path;  ///< from the project's folder on: "studies/dynamic_range/dynamic_range.mustache"
  std::string_view text;
};

/// The templates of all studies, as they were when the program was built.
std::span<const PageTemplate> page_templates();

}  // namespace dtof
