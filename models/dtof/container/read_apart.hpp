// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dtof {

/// Result that a reader returns from its own process.
struct ReadAnswer {
  std::vector<std::size_t> sizes = {};
  std::vector<double> values = {};
  std::vector<std::string> names = {};
};

/// Runs `read` in a process of its own and returns its result, so that a crash in a library does not end the
/// program. Throws InputError as `read` does, and "<path>: damaged: ..." if the process ended without a
/// result.
ReadAnswer read_apart(const std::filesystem::path& path, const std::function<ReadAnswer()>& read);

/// One piece of data that may be larger than memory.
using ReadPiece = std::vector<std::uint64_t>;
using GivePiece = std::function<void(const ReadPiece&)>;

/// Runs `read` in a process of its own and passes each piece that it gives to `take`, in the same order.
/// `take` runs in the caller's process while the next piece is read; an exception from it ends the other
/// process. Throws InputError as read_apart does, after the pieces read so far.
void read_pieces_apart(const std::filesystem::path& path, const std::function<void(const GivePiece&)>& read,
                       const std::function<void(const ReadPiece&)>& take);

}  // namespace dtof
