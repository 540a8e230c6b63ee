// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace dtof {

/// Writes a file that a measurement can do without. If there is an obstacle, the file is left out, an older
/// one is removed, and standard output has a line that says why. Returns whether the file is written.
bool write_optional(const std::filesystem::path& path, const std::string& obstacle,
                    const std::function<void()>& write);

}  // namespace dtof
