// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace dtof {

/// Address of an array in a file, as typed on a command line: "file.h5:/measured/cube", "file.npz:depth_m",
/// or the file alone.
struct ArrayAddress {
  std::filesystem::path file;
  std::string array;  ///< empty: no array is named
};

/// Splits `text` at its last colon into file and array. The whole text is the file if a file of that name
/// exists, or if no file exists with the name before the colon.
ArrayAddress parse_array_address(const std::string& text);

}  // namespace dtof
