// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dtof {

/// A word as a shell (bash) takes it: as it stands where nothing in it means anything to a shell, else in
/// quotation marks; with bytes that no terminal shows as $'...'.
std::string shell_word(std::string_view word);

/// The words of a command line, to be pasted into a shell.
std::string shell_command(std::string_view program, std::span<const char* const> arguments);

}  // namespace dtof
