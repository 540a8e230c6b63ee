// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dtof {

/// A command line, quoted for a shell, without the options of these names (with their dashes), each of which
/// has one value.
std::string without_options(std::string_view command, std::span<const std::string_view> names);

}  // namespace dtof
