// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dtof {

/// Returns the known name that was probably meant, or empty. It is the name that needs the fewest edits
/// (optimal string alignment: insert, delete, replace, swap two neighbours). At most a third of the letters
/// of `name` may be edits, or one letter of a short name.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// Error text, e.g. "unknown scene 'rom'; did you mean 'room'? Known are flat, room", with `kind` = "scene".
std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string_view> known);

}  // namespace dtof
