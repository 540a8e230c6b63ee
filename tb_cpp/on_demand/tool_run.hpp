// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace dtof {

/// Result of a program on PATH.
struct ToolRun {
  int exit_code = 0;   ///< 128 and above: ended by a signal
  std::string output;  ///< first megabyte of standard output and standard error
};

/// Runs `command` in `folder` (empty: the current one) and waits for its end. Returns nothing if there is no
/// such program. Calls `tick` about ten times a second. If the user interrupts (Interrupted), the program and
/// its children are ended first.
std::optional<ToolRun> run_tool(std::span<const std::string> command, const std::filesystem::path& folder,
                                const std::function<void()>& tick = {});

}  // namespace dtof
