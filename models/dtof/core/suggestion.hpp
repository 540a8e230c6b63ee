// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dtof {

/// The known name that was probably meant: the one that the fewest edits (a letter inserted, left out or
/// replaced, two neighbours swapped: optimal string alignment) turn into `name`, if these are at most a third
/// of its letters, or one letter of a short name. Empty if there is none.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// E.g. "unknown scene 'rom'; did you mean 'room'? Known are flat, room". `kind` is "scene".
std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string_view> known);

}  // namespace dtof
