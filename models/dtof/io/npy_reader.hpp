// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dtof/io/array_reader.hpp"
#include "dtof/io/byte_source.hpp"
#include "dtof/io/npy_header.hpp"

namespace dtof {

/// An NPY file, or one in an archive, as read_npy reads it, yet piece by piece and of any length. An array in
/// Fortran order is held, and may have 2^27 elements.
class NpyReader final : public ArrayReader {
 public:
  /// Reads the header. `label` is for messages. Throws InputError "<label>: <reason>".
  NpyReader(std::filesystem::path label, std::unique_ptr<ByteSequence> bytes);

  void next(std::span<double> values) override;
  [[nodiscard]] bool any_place() const override;
  void read_at(std::size_t first, std::span<double> values) const override;

 private:
  struct Opened;
  NpyReader(std::filesystem::path label, Opened opened);
  void hold_reordered();

  std::filesystem::path label_;
  std::unique_ptr<ByteSequence> bytes_;
  NpyHeader header_;
  std::vector<char> raw_;  ///< elements as they stand in the file
  std::size_t next_ = 0;
  std::unique_ptr<HeldArray> reordered_;  ///< of Fortran order, once it is read
};

/// Opens an NPY file that is a regular file.
std::unique_ptr<ArrayReader> open_npy(const std::filesystem::path& path);

}  // namespace dtof
