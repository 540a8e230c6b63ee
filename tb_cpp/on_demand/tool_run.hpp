// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace dtof {

/// What a program on PATH did.
struct ToolRun {
  int exit_code = 0;   ///< 128 and more: ended by a signal
  std::string output;  ///< standard output and standard error, the first megabyte of them
};

/// Runs `command` in `folder` (here, if empty) and waits; nothing if there is no such program. `tick` is
/// called about ten times a second. If the user interrupts (Interrupted), the program and its children end
/// first.
std::optional<ToolRun> run_tool(std::span<const std::string> command, const std::filesystem::path& folder,
                                const std::function<void()>& tick = {});

}  // namespace dtof
