// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace dtof {

/// Creates `folder` and its missing parents. Throws OutputError "<path>: cannot create the output folder:
/// <reason>".
void create_output_folder(const std::filesystem::path& folder);

}  // namespace dtof
