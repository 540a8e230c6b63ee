// SPDX-License-Identifier: Apache-2.0
#include "dtof/io/output_folder.hpp"

#include <fmt/format.h>

#include <system_error>

#include "dtof/io/output_error.hpp"

namespace dtof {

void create_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw OutputError(
        fmt::format("{}: cannot create the output folder: {}", folder.string(), error.message()));
  }
}

}  // namespace dtof
