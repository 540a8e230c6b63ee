// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dtof {

/// Quotes a word for bash: unchanged if it has no special characters, else in quotation marks, or as $'...'
/// if it has unprintable bytes.
std::string shell_word(std::string_view word);

/// Quotes a command line for pasting into a shell.
std::string shell_command(std::string_view program, std::span<const char* const> arguments);

/// The same command without -j, --threads and their value: no result depends on them, so no picture names
/// them.
std::string without_threads(std::string_view command);

}  // namespace dtof
