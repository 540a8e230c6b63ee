// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace dtof::fuzz {

/// The fuzzer's bytes as a file in memory, for the readers, which take a path. Every call overwrites the last
/// one's file.
std::filesystem::path input_file(const std::uint8_t* data, std::size_t size);

}  // namespace dtof::fuzz
