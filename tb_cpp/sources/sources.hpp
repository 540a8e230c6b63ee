// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace dtof {

/// A file of the project, as compiled into the program.
struct SourceFile {
  std::string_view path;  ///< relative to the project's folder, e.g. "hdl/thesis/dtof_array.sv"
  std::string_view text;
};

/// All compiled-in files, sorted by path: RTL, testbenches with the headers for Verilated models, driver and
/// constraints.
std::span<const SourceFile> project_sources();

}  // namespace dtof
