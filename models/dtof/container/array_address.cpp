// SPDX-License-Identifier: Apache-2.0
#include "dtof/container/array_address.hpp"

#include <system_error>

namespace dtof {

ArrayAddress parse_array_address(const std::string& text) {
  std::error_code error;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon + 1 == text.size() || std::filesystem::exists(text, error) ||
      !std::filesystem::exists(text.substr(0, colon), error)) {
    return {.file = text, .array = {}};
  }
  return {.file = text.substr(0, colon), .array = text.substr(colon + 1)};
}

}  // namespace dtof
