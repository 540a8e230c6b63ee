// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace dtof {

/// Writes an optional file of a measurement. With a non-empty `obstacle` the file is not written, an older
/// one is removed, and a line on standard output gives the reason. Returns whether the file was written.
bool write_optional(const std::filesystem::path& path, const std::string& obstacle,
                    const std::function<void()>& write);

}  // namespace dtof
