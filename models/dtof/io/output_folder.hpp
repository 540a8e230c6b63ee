// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace dtof {

/// Creates `folder` and what leads to it. Throws InputError with path and reason.
void create_output_folder(const std::filesystem::path& folder);

}  // namespace dtof
