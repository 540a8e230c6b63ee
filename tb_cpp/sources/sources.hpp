// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace dtof {

/// A file of the project as it was when the program was built.
struct SourceFile {
  std::string_view path;  ///< from the project's folder on, e.g. "hdl/thesis/dtof_array.sv"
  std::string_view text;
};

/// RTL, testbenches with the headers that a Verilated model needs, driver and constraints, by their paths.
std::span<const SourceFile> project_sources();

}  // namespace dtof
