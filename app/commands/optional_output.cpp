// SPDX-License-Identifier: Apache-2.0
#include "commands/optional_output.hpp"

#include <fmt/format.h>

#include <system_error>

namespace dtof {

bool write_optional(const std::filesystem::path& path, const std::string& obstacle,
                    const std::function<void()>& write) {
  if (obstacle.empty()) {
    write();
    return true;
  }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  fmt::print("{} is left out: {}\n", path.string(), obstacle);
  return false;
}

}  // namespace dtof
