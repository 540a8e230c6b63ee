// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dtof {

/// What a reader in a process of its own gives back.
struct ReadAnswer {
  std::vector<std::size_t> sizes = {};
  std::vector<double> values = {};
  std::vector<std::string> names = {};
};

/// The answer of `read`, which runs in a process of its own: a library that a damaged file brings down takes
/// only that process along. Throws InputError as `read` does, and "<path>: damaged: ..." where the process
/// ended without an answer.
ReadAnswer read_apart(const std::filesystem::path& path, const std::function<ReadAnswer()>& read);

}  // namespace dtof
