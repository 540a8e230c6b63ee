// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace dtof {

/// Whole contents of a file. Throws InputError "<path>: <reason>" when it is missing, unreadable, a directory
/// or empty.
std::string read_file(const std::filesystem::path& path);

/// As `read_file`, and unpacks gzip (recognised by its first two bytes). Throws also when the gzip data is
/// damaged or ends early.
std::string read_file_or_gzip(const std::filesystem::path& path);

}  // namespace dtof
