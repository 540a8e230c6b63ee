// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace dtof {

/// An array in a file, as a command line has it: "file.h5:/measured/cube", "file.npz:depth_m", or the file
/// alone.
struct ArrayAddress {
  std::filesystem::path file;
  std::string array;  ///< empty: not named
};

/// What stands behind the last colon is the array's name where no file has the whole text as its name, and a
/// file has what stands before.
ArrayAddress parse_array_address(const std::string& text);

}  // namespace dtof
