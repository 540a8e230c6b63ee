// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
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

/// A part of what is longer than memory.
using ReadPiece = std::vector<std::uint64_t>;
using GivePiece = std::function<void(const ReadPiece&)>;

/// The same for what comes in pieces: `read` gives each to the function that it is called with, in a process
/// of its own, and `take` has each here, in the same order, while the next one is read. An exception of
/// `take` ends the other process. Throws InputError as above; pieces before it have been taken.
void read_pieces_apart(const std::filesystem::path& path, const std::function<void(const GivePiece&)>& read,
                       const std::function<void(const ReadPiece&)>& take);

}  // namespace dtof
